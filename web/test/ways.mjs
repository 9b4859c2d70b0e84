// A server with plans, for all cases that look at them: a way into the scene that `sinew new scene` prints, one that touches, one too far in.
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {serve, sinew} from './harness.mjs';

let made = null;

/** A server with both plans; one for all cases. */
export async function plans() {
  if (made) return made;
  const folder = mkdtempSync(join(tmpdir(), 'sinew-plans-')), file = (name) => join(folder, name);
  process.once('exit', () => rmSync(folder, {recursive: true}));
  writeFileSync(file('wall.yaml'), execFileSync(sinew, ['new', 'scene']));
  execFileSync(sinew, ['plan', file('wall.yaml'), '-o', file('wall.csv'), '-q']);
  const [head, ...rows] = readFileSync(file('wall.csv'), 'utf8').split('\n').filter((line) => line && !line.startsWith('#'));
  const changed = (change) => [head, ...rows.map((row, i) => change(row.split(','), i).join(','))].join('\n');
  writeFileSync(file('touch.csv'), changed((row, i) => (i >= 100 && i < 120 ? [...row.slice(0, 2), '0.05', ...row.slice(3)] : row)));
  writeFileSync(file('far.csv'), changed((row, i) => (i >= 280 ? [row[0], '0.2', ...row.slice(2)] : row)));
  writeFileSync(file('other.csv'), changed((row) => row).replace('S4_beta_1', 'S4_theta'));
  const all = await serve('--scene', file('wall.yaml'), '--plan', file('wall.csv'), '--plan', file('touch.csv'), '--plan', file('far.csv'));
  all.server.unref();  // the exit of the tests, which it is not to keep from coming, ends it
  all.server.stdout.unref();
  const listed = (await (await fetch(new URL('/api/plans', all.url))).json()).plans, handles = Object.fromEntries(listed.map(({name, plan}) => [name, plan]));
  for (const handle of Object.values(handles)) while (!(await (await fetch(new URL(`/api/plans/${handle}`, all.url))).json()).check) await new Promise((next) => setTimeout(next, 50));
  return made = {...all, file, handles, last: rows.length - 1};
}
