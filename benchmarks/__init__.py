"""How long things take, how surely they are solved, and how both compare with other methods."""
