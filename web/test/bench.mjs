// A page of nothing but a picture, for the tests of pictures: its modules, the page's own colours, the server's robots.
import {build} from 'esbuild';
import {createServer, request} from 'node:http';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';

const policy = "default-src 'self'; img-src 'self' blob: data:; style-src 'self'";  // what of the server's pictures meet
const html = `<!doctype html><html lang="en"><meta charset="utf-8"><title>picture</title><link rel="icon" href="data:,">
<link rel="stylesheet" href="/app.css"><link rel="stylesheet" href="/bench.css"><script type="module" src="/app.js"></script>
<body><div id="view" tabindex="0"></div><div id="small"></div></body></html>`;
const css = 'body { display: block; } #view { position: absolute; inset: 0 0 auto 0; height: 100%; overflow: hidden; background: var(--scene); }';

const entry = `
import './app.css';
import {Robot, robotText} from './client';
import {describe} from './described';
import {drawingOf} from './drawn';
import {makePicture} from './picture_of';
import {shape} from './questions';
import {sketch} from './sketch';
import {stateOf} from './state';
import {bowed} from './tendon_lines';

const box = document.getElementById('view'), picture = makePicture(box), told = {grabbed: [], notes: [], moved: 0}, known = {};
picture.grabbed = (position, isEnd) => told.grabbed.push({position: [...position], isEnd});
picture.note = (text) => told.notes.push(text);
picture.moved = () => { ++told.moved; };
picture.labelOf = ({kind, index, tendon}) => [kind, index, tendon].filter((part) => part !== undefined).join(' ');

/** What would be drawn of a robot at its home, or where change(inputs) leads to. */
async function drawing(name, change = (inputs) => inputs, alter = (shape) => shape) {
  known[name] ??= await robotText(name).then(Robot.open).then(async (robot) => ({robot, described: await describe(robot)}));
  const {robot, described} = known[name], home = stateOf(described), state = {...home, inputs: change(home.inputs, described.inputs)};
  const [found] = await robot.ask([shape(described, state)]);
  if (!found.backbones) throw new Error(name + ': ' + JSON.stringify(found));
  const altered = alter(found);
  return drawingOf(described, state, altered, altered);
}
const paint = () => picture.paint(getComputedStyle(document.documentElement));
const still = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
Object.assign(window, {bench: {box, picture, told, drawing, paint, still, sketch, bowed}});
`;

/** @param to address of a sinew serve, which answers what the page asks */
export async function bench(to) {
  const made = await build({
    stdin: {contents: entry, resolveDir: join(dirname(fileURLToPath(import.meta.url)), '../src'), loader: 'ts'},
    bundle: true, format: 'esm', target: 'es2022', outdir: '/', write: false,
  });
  const files = new Map(made.outputFiles.map(({path, text}) => [path.endsWith('.css') ? '/app.css' : '/app.js', text]));
  files.set('/', html);
  files.set('/bench.css', css);
  const types = {'/': 'text/html', '/app.js': 'text/javascript', '/app.css': 'text/css', '/bench.css': 'text/css'};
  const server = createServer((asked, answer) => {
    const path = asked.url.split('?')[0];
    if (files.has(path)) {
      answer.writeHead(200, {'Content-Type': `${types[path]}; charset=utf-8`, 'Content-Security-Policy': policy});
      return answer.end(files.get(path));
    }
    const {host, port} = new URL(to), {'content-type': type, 'content-length': length} = asked.headers;
    // each on a connection of its own: one that is kept may be closed by the server just as it is used again
    const passed = request({hostname: '127.0.0.1', port, agent: false, path: asked.url, method: asked.method, headers: {Host: host, ...(type && {'Content-Type': type}), ...(length && {'Content-Length': length})}}, (reply) => {
      answer.writeHead(reply.statusCode, {'Content-Type': reply.headers['content-type']});
      reply.pipe(answer);
    });
    passed.on('error', () => answer.destroy());  // the page sees it, as it would without what is between
    asked.pipe(passed);
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  return {server, url: `http://127.0.0.1:${server.address().port}/`};
}
