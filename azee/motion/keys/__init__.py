"""The postures that a movement passes through."""
