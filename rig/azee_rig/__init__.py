"""A signing body: skeleton, joint coordinates and limits, sites, skin and morphs."""
