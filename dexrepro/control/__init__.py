"""Control laws, one a file, under one contract (:mod:`dexrepro.control.contract`), and what they are built from."""
