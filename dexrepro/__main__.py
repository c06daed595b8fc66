"""``python -m dexrepro``."""

import sys

sys.path.append(sys.path.pop(0))  # the folder it is started in: behind all that is installed

from dexrepro.cli import main

if __name__ == "__main__":
    sys.exit(main())
