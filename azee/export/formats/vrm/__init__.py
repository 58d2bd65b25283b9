"""VRM 1.0: our bodies as avatars, and movements that any avatar plays (VRMA)."""
