"""``python -m dexrepro``."""

import sys

from dexrepro.cli import main

if __name__ == "__main__":
    sys.exit(main())
