"""The prompt at which AZee is tried: `azee repl`."""
