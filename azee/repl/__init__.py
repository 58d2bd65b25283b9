"""The prompt for trying AZee: `azee repl`."""
