"""Makes a rig from a body: chain, sites, capsules, clothes. Needs trimesh; playing does not."""
