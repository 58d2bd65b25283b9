"""Making a rig from a body: chain, sites, capsules, dress. Needs trimesh; playing does not."""
