module hypcheck-adapter

go 1.20
