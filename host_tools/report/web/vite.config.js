import { readFileSync } from 'node:fs';
import { defineConfig } from 'vite';

// Two pages: index.html (report) and, with --mode serve, serve.html (`traction serve`); with --mode scene the code of the replay.
// Puts the one script and the one style sheet into the page, so that a single file opens from disk, and the notice that uPlot's
// licence asks for (MIT) before them.
function oneFile(nonce) {
  return {
    name: 'one-file',
    enforce: 'post',
    generateBundle(_, bundle) {
      const page = Object.values(bundle).find((file) => file.fileName.endsWith('.html'));
      let html = page.source;
      for (const file of Object.values(bundle)) {
        if (file.fileName.endsWith('.js')) {
          const code = file.code.replaceAll('</script', '<\\/script');
          html = html.replace(/<script[^>]*\ssrc="[^"]*"[^>]*><\/script>/, '');
          html = html.replace('</body>', () => `<script type="module"${nonce}>${code}</script>\n</body>`);
        } else if (file.fileName.endsWith('.css')) {
          html = html.replace(/<link[^>]*rel="stylesheet"[^>]*>/, () => `<style${nonce}>${file.source}</style>`);
        } else continue;
        delete bundle[file.fileName];
      }
      const licence = readFileSync('node_modules/uplot/LICENSE', 'utf8').trim();
      page.source = html.replace('<head>', () => `<head>\n<!-- Contains uPlot (https://github.com/leeoniya/uPlot):\n${licence}\n-->`);
    },
  };
}

// The code that draws a drive in three dimensions: a script of its own (page/scene.js), which `traction report` puts as text into pages that
// have a drive. Its first lines are the notice of three.js (MIT).
function sceneFile() {
  return {
    name: 'scene-file',
    enforce: 'post',
    generateBundle(_, bundle) {
      const licence = readFileSync('node_modules/three/LICENSE', 'utf8').trim();
      for (const file of Object.values(bundle))
        file.code = `/* Contains three.js (https://threejs.org):\n${licence}\n*/\n${file.code.replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--')}`;
    },
  };
}

const scene = { target: 'es2020', emptyOutDir: false, lib: { entry: 'src/scene/scene.js', formats: ['iife'], name: 'tractionScene', fileName: () => 'scene.js' } };

export default defineConfig(({ mode }) => ({
  base: './',
  build: mode === 'scene' ? scene : { target: 'es2020', modulePreload: false, cssCodeSplit: false, assetsInlineLimit: 1e6, emptyOutDir: mode !== 'serve',
    rollupOptions: { input: mode === 'serve' ? 'serve.html' : 'index.html' } },
  define: { 'process.env.NODE_ENV': '"production"' },
  plugins: [mode === 'scene' ? sceneFile() : oneFile(mode === 'serve' ? ' nonce="__TRACTION_NONCE__"' : '')],
}));
