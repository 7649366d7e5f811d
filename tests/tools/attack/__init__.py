"""An attack on the kernel's bounds: rows where floats are about to be wrong, against decisions that use none.

make attack      # ten million rows and more, every kernel and instruction set of this machine
"""
