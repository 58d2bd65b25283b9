"""`python -m azee` is the `azee` command."""

from azee.cli.main import main

main()
