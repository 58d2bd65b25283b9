// Finds the least depth in the 3 x 3 tiles around each, of one size.
uniform sampler2D tiles;
uniform int row;
uniform int count; // tiles of this size, each way
out vec4 least;

void main() {
    ivec2 middle = ivec2(gl_FragCoord.xy) - ivec2(0, row);
    least = vec4(1e30);
    for (int y = -1; y < 2; ++y) {
        for (int x = -1; x < 2; ++x) {
            ivec2 at = clamp(middle + ivec2(x, y), 0, count - 1) + ivec2(0, row);
            least.x = min(least.x, texelFetch(tiles, at, 0).x);
        }
    }
}
