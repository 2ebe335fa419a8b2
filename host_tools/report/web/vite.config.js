import { readFileSync } from 'node:fs';
import { defineConfig } from 'vite';

// Two pages: index.html (report) and, with --mode serve, serve.html (`traction serve`).
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

export default defineConfig(({ mode }) => ({
  base: './',
  build: { target: 'es2020', modulePreload: false, cssCodeSplit: false, assetsInlineLimit: 1e6, emptyOutDir: mode !== 'serve',
    rollupOptions: { input: mode === 'serve' ? 'serve.html' : 'index.html' } },
  plugins: [oneFile(mode === 'serve' ? ' nonce="__TRACTION_NONCE__"' : '')],
}));
