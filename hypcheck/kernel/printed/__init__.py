"""Python printed from the programs of kernel/programs by `python -m hypcheck.kernel.printing.modules`."""
