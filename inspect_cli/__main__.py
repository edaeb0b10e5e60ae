"""``python -m inspect_cli``."""

from inspect_cli.cli import main

if __name__ == "__main__":
    main()
