"""What a reader who implements Chapter 5 must know beyond the printed equations."""

ERRATA = ()
