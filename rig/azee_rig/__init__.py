"""A body that can sign: skeleton, joint coordinates and limits, sites, skin and morphs."""
