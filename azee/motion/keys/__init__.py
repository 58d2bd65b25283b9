"""Key postures: those that a movement passes through."""
