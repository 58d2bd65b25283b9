// Writes which triangle a sample shows, counted from 1, and its depth.
in float depth;
out vec2 found;

void main() {
    found = vec2(float(gl_PrimitiveID + 1), depth);
}
