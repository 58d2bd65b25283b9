"""Lexicons of other notations as AZee rules: gestural SiGML and HamNoSys."""
