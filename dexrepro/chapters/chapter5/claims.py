"""What Chapter 5 claims, as predicates over measured numbers."""

CLAIMS = ()
REFERENCES = ()
