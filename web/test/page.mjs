// node page.mjs SINEW CHROMIUM FOLDER [MODULE|CASE ...]: the page of sinew serve in a real browser; screenshots go to FOLDER.
import assert from 'node:assert/strict';
import * as arms from './arms.mjs';
import * as demo from './demo.mjs';
import * as design from './design.mjs';
import * as drive from './drive.mjs';
import * as errors from './errors.mjs';
import {isThorough, launch, serve} from './harness.mjs';
import * as honest from './honest.mjs';
import * as jog from './jog.mjs';
import * as log from './log.mjs';
import * as looks from './looks.mjs';
import * as notebook from './notebook.mjs';
import * as operate from './operate.mjs';
import * as plans from './plans.mjs';
import * as robots from './robots.mjs';
import * as speed from './speed.mjs';

const modules = {robots, design, arms, drive, errors, honest, jog, looks, operate, log, plans, speed, notebook, demo}, wanted = process.argv.slice(5);
const cases = Object.entries(modules).flatMap(([module, all]) => Object.entries(all).map(([name, run]) => ({module, name, run})));
for (const one of wanted) assert.ok(cases.some(({module, name}) => one === module || one === name), `${one} is no module and no case`);

// What is about the picture itself is seen by WebGL; what is about the rest of the page passes by the simpler picture just as well.
const isAboutPictures = ({module, name}) => isThorough || ['robots', 'looks', 'speed'].includes(module) && name !== 'accessibility' || name === 'links' || name === 'arm_answers' || ['plan_pictures', 'operate_pictures', 'drive_pictures', 'jog_pictures'].includes(name);
const {server, url} = await serve(), browsers = new Map();
async function browserFor(one) {
  const hasWebGL = isAboutPictures(one);
  if (!browsers.has(hasWebGL)) browsers.set(hasWebGL, await launch({hasWebGL}));
  return browsers.get(hasWebGL);
}

try {
  for (const one of cases) {
    const {module, name, run} = one;
    if (wanted.length > 0 && !wanted.includes(module) && !wanted.includes(name)) continue;
    const browser = await browserFor(one), begin = performance.now();
    await run(browser, url).catch((error) => { throw new Error(`${name}: ${error.message}`, {cause: error}); });
    console.log(`${name}: ${((performance.now() - begin) / 1000).toFixed(1)} s`);
  }
} finally {
  for (const browser of browsers.values()) await browser.close();
  server.kill('SIGINT');
}
