"""The command line: python3 -m sunfleck VERB ..."""

import sys

from ._core import main


def run() -> None:
    """Does what the arguments say and leaves the interpreter with the exit code (docs/how-to.md)."""
    sys.exit(main(["sunfleck", *sys.argv[1:]]))


if __name__ == "__main__":
    run()
