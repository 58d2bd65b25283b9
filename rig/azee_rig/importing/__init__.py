"""Takes in bodies that others made: skinned glTF and VRM, under whatever joint names."""
