// Builds the pages into dist/, which is committed: neither `pip install` nor `make demo` needs Node.
// The same sources and lock file give the same bytes; tests/web/test_bundle.py holds us to it.
import { defineConfig } from 'vite';

const LIBRARIES = [
  { name: 'vendor-three', test: /node_modules[\\/]three[\\/]/ },
  { name: 'vendor-editor', test: /node_modules[\\/](?!three[\\/])/ },
];

export default defineConfig({
  base: './', // a page may be served from any folder, also behind a token
  build: {
    outDir: 'dist',
    target: 'es2022',
    assetsInlineLimit: 0, // a content security policy without data: scripts and styles holds
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1200,
    license: { fileName: 'LICENSES.md' },
    rolldownOptions: {
      input: {
        player: 'player.html',
        studio: 'studio.html',
        'azee-player': 'src/player/element.ts',
      },
      output: {
        // Names without hashes can be written into pages of others; servers revalidate by ETag.
        entryFileNames: '[name].js',
        chunkFileNames: '[name].js',
        assetFileNames: '[name][extname]',
        codeSplitting: { groups: LIBRARIES },
      },
    },
  },
});
