"""The renderer that draws by OpenGL 3.3 the pictures of our rasteriser."""
