// node build.mjs FOLDER: the page's files, each also compressed, the same bytes every time.
import {build} from 'esbuild';
import {mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {gzipSync} from 'node:zlib';

const here = dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2] ?? join(here, 'dist');
mkdirSync(folder, {recursive: true});

const made = await build({
  entryPoints: {app: join(here, 'src/main.ts'), editor: join(here, 'src/editor.ts')},
  external: ['./editor.js'],  // comes when it is wanted
  bundle: true,
  minify: true,
  format: 'esm',
  target: 'es2022',
  legalComments: 'none',
  banner: {js: '/* three.js, uPlot, CodeMirror: MIT, (c) their authors */'},
  outdir: folder,
  write: false,
});
const files = made.outputFiles.map((file) => [file.path.split('/').pop(), Buffer.from(file.contents)]);
files.push(['index.html', readFileSync(join(here, 'index.html'))]);
let total = 0;
for (const [name, bytes] of files) {
  const small = gzipSync(bytes, {level: 9});
  writeFileSync(join(folder, name), bytes);
  writeFileSync(join(folder, name + '.gz'), small);
  total += small.length;
}
console.log(`the page: ${(total / 1000).toFixed(1)} kB compressed`);
