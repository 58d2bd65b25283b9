"""Imports bodies that others made: skinned glTF and VRM, with any joint names."""
