// Places projected vertices: x and y in samples from the upper left, and a depth.
// A vertex that is not in front of the eye has a depth so far beyond the greatest that nothing is
// left of its triangles when they are clipped: as in our rasteriser, they are left out.
// Row 0 of a buffer is the uppermost of the picture, so that nothing is turned over.
uniform vec2 size;
uniform vec2 depths; // least and greatest
in vec3 point;
out float depth;

void main() {
    float share = (point.z - depths.x) / (depths.y - depths.x);
    gl_Position = vec4(2.0 * point.xy / size - 1.0, 1.998 * share - 0.999, 1.0);
    depth = point.z;
}
