"""The `azee` command, one module per subcommand."""
