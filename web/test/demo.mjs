// The screen Operate at the real thing: `sinew serve --demo`, with the firmware in simulation and the simulated arm on its drives.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {once} from 'node:events';
import {existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {blank, drawn, launch, serve, shot, sinew} from './harness.mjs';

const isBuilt = ['sinew-simulate', 'sinew-firmware-panel.elf'].every((name) => existsSync(join(dirname(sinew), name)));

/** A server with a device, and what it leaves behind. */
async function demonstrated(robot, act) {
  const folder = mkdtempSync(join(tmpdir(), 'sinew-demo-test-')), {server, url} = await serve(robot, '--demo', '--record', folder);
  try {
    await act(url, folder, server);
  } finally {
    const ended = once(server, 'exit');
    server.kill('SIGINT');
    await ended;
    rmSync(folder, {recursive: true});
  }
}

const pause = (ms) => new Promise((next) => setTimeout(next, ms));
const frame = (page) => page.evaluate(() => window.__sinew.operate.frame);
const words = async (page) => (await frame(page)).sections.map(({word}) => word);

/** What matters of a frame, for who reads why a test failed. */
const brief = (now) => JSON.stringify(now && {state: now.state, activity: now.activity, why: now.why, link: now.link, homing: now.homing, insertion: now.insertion, speed: now.speed,
                                              sections: now.sections.map(({word, measured, target, tension, advice}) => ({word, measured, target, tension, advice}))});

/** Waits until the newest frame is so. */
async function told(page, is, longest = 20e3) {
  for (const end = performance.now() + longest; ;) {
    const now = await page.evaluate(() => window.__sinew?.operate?.frame ?? null);
    if (now && is(now)) return drawn(page);
    assert.ok(performance.now() < end, `it did not come: ${is}; ${brief(now)}`);
    await pause(50);
  }
}

const allExact = ({sections}) => sections.every(({word}) => word === 'EXACT');
const bar = (page, name) => page.locator('#op-bar').getByRole('button', {name});

const centre = ({x, y, width, height}) => [x + width / 2, y + height / 2];

/**
 * Presses a button until a frame is so, and keeps it down. A machine that stalls for 0.3 s stops the motion, for longer disarms, and ends the lease at last: then all is got ready and the button is pressed anew, as by an operator.
 * @param ready makes it so that the button may be pressed; it does nothing where that is so
 */
async function pressUntil(page, button, is, {ready = armed, longest = 60e3, meanwhile} = {}) {
  const end = performance.now() + longest;
  for (let isDown = false; ;) {
    const now = await frame(page);
    if (is(now)) break;
    await meanwhile?.(now);
    assert.ok(performance.now() < end, `held, but it did not come: ${is}; ${brief(now)}`);
    if (isDown && now.activity === 'rest') {
      await page.mouse.up();
      await pause(250);
      isDown = false;
    }
    if (!isDown) {
      await ready(page);
      await page.mouse.move(...centre(await button.boundingBox()));
      await page.mouse.down();
      await pause(350);
      isDown = true;
    }
    await pause(50);
  }
}

async function holdUntil(page, button, is, options) {
  await pressUntil(page, button, is, options);
  await page.mouse.up();
  await drawn(page);
}

async function look(browser, url, options) {
  const opened = await blank(browser, options);
  await opened.page.goto(url);
  await told(opened.page, ({link}) => link === 'ok' || link === 'wrong_table');
  return opened;
}

const stalls = /answer|let go|no word|silent|without motion/;

/** In control, with the dialog of arming: where a stall has ended the lease, it is taken anew. */
async function readyToHome(page) {
  const {state, why} = await frame(page);
  if (state === 'view_only') {
    console.log(`  control ended: ${why}`);
    assert.match(why, stalls);
    await bar(page, /Take control/).click();
  }
  if (!await page.locator('.arming-dialog').isVisible()) await bar(page, /Arm…/).click();
}

async function home(page, folder) {
  await bar(page, /Arm…/).click();
  await page.locator('.arming-dialog', {hasText: 'hold Home until all tendons are done'}).waitFor();
  assert.ok(await page.getByRole('button', {name: 'Hold 1 s to arm'}).isDisabled());
  const button = page.locator('.arming-dialog .home'), begin = performance.now();
  let isSeen = false;
  await holdUntil(page, button, ({homing}) => homing?.done >= 7, {ready: readyToHome, meanwhile: async ({homing}) => {
    if (isSeen || !(homing?.done >= 4)) return;
    isSeen = true;
    await shot(page, 'demo-homing');
  }});
  await pause(300);
  assert.ok((await frame(page)).homing.done >= 7, 'what is ticked stays so when the button is released');
  assert.ok(await page.locator('.arming-dialog .ticks .done').count() >= 7);
  await holdUntil(page, button, ({homed}) => homed, {ready: readyToHome});
  console.log(`  homed in ${((performance.now() - begin) / 1000).toFixed(1)} s`);
  await page.locator('.arming-dialog', {hasText: /Homed \d{4}-\d\d-\d\d .* at 5\.0 N/}).waitFor();
  await told(page, allExact);
  await shot(page, 'demo-homed');
  const [file] = readdirSync(folder).filter((name) => name.endsWith('-homing.json')), kept = JSON.parse(readFileSync(join(folder, file)));
  assert.equal(kept.tendons.length, 15);
  for (const {tension} of kept.tendons) assert.ok(Math.abs(tension - 5) < 1, `${tension} N`);
}

async function arm(page) {
  if (!await page.locator('.arming-dialog').isVisible()) await bar(page, /Arm…/).click();
  const {x, y} = await page.getByRole('button', {name: 'Hold 1 s to arm'}).boundingBox();
  await page.mouse.move(x + 20, y + 20);
  await page.mouse.down();
  await page.locator('.arming-dialog').waitFor({state: 'hidden'});
  await page.mouse.up();
}

/** A click into a section's diagram is its target. */
async function aim(page, section, x, y) {
  const plot = await page.locator('.plot-of').nth(section).boundingBox();
  await page.mouse.click(plot.x + x * plot.width, plot.y + y * plot.height);
}

const isThere = ({sections}) => sections.every(({target, measured}) => Math.hypot(target[0] - measured[0], target[1] - measured[1]) < 2e-3);

/** Armed, anew where a stall has disarmed, which it says. */
async function armed(page) {
  const {state, why} = await frame(page);
  if (state === 'armed') return;
  console.log(`  disarmed: ${why}`);
  assert.match(why, stalls);
  await told(page, ({link}) => link === 'ok');
  if (state === 'view_only') await bar(page, /Take control/).click();
  await arm(page);
}

async function moves(page) {
  for (let i = 0; i < 6; ++i) await page.keyboard.press('+');
  await told(page, ({speed}) => speed > 4.5e-3);
  await aim(page, 1, 0.65, 0.4);
  await aim(page, 3, 0.4, 0.6);
  await told(page, (now) => !isThere(now) && now.sections[1].target[0] > 0.05 && now.sections[3].target[0] < -0.05);
  await shot(page, 'demo-target');
  await holdUntil(page, bar(page, /MOVE/), isThere);
  await told(page, ({activity}) => activity === 'rest');
  await pause(700);  // what is shown is cleared after half a second
  assert.deepEqual(await words(page), Array(5).fill('EXACT'), 'taut at moderate bends');
  await shot(page, 'demo-moved');
}

async function insertsAndRetracts(page) {
  assert.notEqual(await bar(page, /Straighten/).getAttribute('aria-disabled'), 'true');
  await holdUntil(page, bar(page, /Advance/), ({insertion}) => insertion > 6e-3);
  await page.locator('#op-bar').getByText(/locked: \d+ mm in/).waitFor();
  assert.equal(await bar(page, /Straighten/).getAttribute('aria-disabled'), 'true');
  await shot(page, 'demo-inserted');
  await holdUntil(page, bar(page, /Retract/), ({insertion}) => insertion < 2e-4);
  await told(page, allExact);
}

async function secondPage(browser, url, page) {
  const second = await look(browser, url, {theme: 'dark'});
  await bar(second.page, /VIEW ONLY/).waitFor();
  assert.match(await bar(second.page, /VIEW ONLY/).innerText(), /another page controls since \d\d:\d\d/);
  await shot(second.page, 'demo-second');
  const server = await watch(url);
  await pressUntil(page, bar(page, /Straighten/), ({activity}) => activity === 'straighten');
  const isHeld = server.next(({activity}) => activity === 'holding');
  await bar(second.page, /HOLD/).click();
  await isHeld;
  server.close();
  await pause(400);
  const held = await frame(page);  // on a busy machine the page may have fallen silent meanwhile, which ends the hold
  assert.ok(held.activity === 'holding' || (held.activity === 'rest' && held.state !== 'armed'), `the button that is still held moves nothing: ${held.activity}, ${held.state}`);
  await page.mouse.up();
  await pause(250);
  await second.done();
  await holdUntil(page, bar(page, /Straighten/), ({sections}) => sections.every(({measured: [x, y]}) => Math.hypot(x, y) < 2e-3));
  await told(page, allExact);
}

const fault = async (url, line) => assert.equal((await fetch(new URL('/api/device/fault', url), {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify({line})})).status, 200, line);

async function faults(page, url) {
  await fault(url, 'cut 3 1');
  await told(page, ({sections}) => sections[2].word === 'PARTLY SLACK');
  await page.locator('#op-banner', {hasText: 'Look at tendon 1: no tension'}).waitFor();
  assert.deepEqual((await words(page)).filter((word) => word !== 'EXACT'), ['PARTLY SLACK'], 'no other section');
  await shot(page, 'demo-cut');
  await fault(url, 'mend');
  await told(page, allExact);
  await fault(url, 'unplug');
  await told(page, ({link, state, sections}) => link === 'silent' && state === 'control' && sections.every(({word}) => word === 'NO DATA'));
  await page.locator('#op-banner', {hasText: 'NO DATA'}).waitFor();
  await shot(page, 'demo-unplugged');
  await fault(url, 'plug');
  await told(page, (now) => now.link === 'ok' && now.homed && allExact(now));
  await fault(url, 'reset');
  await told(page, ({homed, state, why}) => !homed && state === 'control' && why !== '');
  await bar(page, /Arm…/).click();
  await page.locator('.arming-dialog', {hasText: 'hold Home until all tendons are done'}).waitFor();
  await shot(page, 'demo-reset');
  await page.getByRole('button', {name: 'Cancel'}).click();
}

/** Frames of the server, as another client sees them: `next` is the first one that is so and came after this was asked. */
async function watch(url) {
  const ended = new AbortController(), reply = await fetch(new URL('/api/device/events', url), {signal: ended.signal}), frames = [];
  let arrived = () => undefined;
  void (async () => {
    let text = '';
    for await (const chunk of reply.body.pipeThrough(new TextDecoderStream())) {
      const parts = (text += chunk).split('\n\n');
      text = parts.pop();
      for (const part of parts) if (part.startsWith('event: frame')) frames.push(JSON.parse(part.slice(part.indexOf('data: ') + 6)));
      arrived();
    }
  })().catch(() => undefined);  // it is ended, or the server is: then frames fail to come
  return {
    frames,
    next: async (is, longest = 20e3) => {
      const late = performance.now() + longest;
      for (let k = frames.length; ; ++k) {
        while (k >= frames.length) {
          assert.ok(performance.now() < late, `the server did not tell: ${is}; ${brief(frames.at(-1))}`);
          await Promise.race([new Promise((next) => { arrived = next; }), pause(100)]);
        }
        if (is(frames[k])) return frames[k];
      }
    },
    close: () => ended.abort(),
  };
}

const farthest = (a, b) => Math.max(...a.sections.map(({measured: [x, y]}, i) => Math.hypot(x - b.sections[i].measured[0], y - b.sections[i].measured[1])));

/** All processes that run pages stand still, as when a lid is closed; or they go on. */
async function freeze(page, signal) {
  const cdp = await page.context().browser().newBrowserCDPSession(), {processInfo} = await cdp.send('SystemInfo.getProcessInfo'), pages = processInfo.filter(({type}) => type === 'renderer');
  assert.ok(pages.length > 0, 'no process runs pages');
  for (const {id} of pages) process.kill(id, signal);
  await cdp.detach();
}

/** A lid is closed while Move is held: shortly, and for longer than the lease lasts. */
async function closedLid(url, page) {
  const server = await watch(url), isMoving = ({activity}) => activity === 'moving';
  for (const lasts of [0.6, 2.4]) {
    await armed(page);
    await aim(page, 1, lasts < 1 ? 0.3 : 0.7, 0.5);
    await told(page, (now) => !isThere(now));
    const from = await frame(page);
    await pressUntil(page, bar(page, /MOVE/), (now) => isMoving(now) && farthest(now, from) > 0.01);
    await freeze(page, 'SIGSTOP');
    const frozen = await server.next(() => true), still = await server.next((now) => !isMoving(now));
    assert.ok(still.time - frozen.time < 0.3 + 0.04 + 0.1, `it moved on for ${still.time - frozen.time} s`);  // and two frames
    const there = await server.next(({time}) => time > still.time + 0.2);  // the arm swings after its drives
    const ended = await server.next(({time}) => time > frozen.time + lasts);
    if (lasts > 2) assert.equal(ended.state, 'view_only');
    else assert.ok(ended.state === 'armed' || stalls.test(ended.why), ended.why);
    await freeze(page, 'SIGCONT');
    const awake = await server.next(({time}) => time > ended.time + 0.5);
    assert.ok(server.frames.filter(({time}) => time > still.time).every((now) => !isMoving(now)), 'the button that is still held moves nothing');
    assert.ok(farthest(awake, there) < 2e-3, `it moved by ${farthest(awake, there)}`);
    await told(page, ({time, state, why, activity}) => time >= awake.time && (state === ended.state || stalls.test(why)) && activity === 'rest');
    if (lasts > 2) await bar(page, /Take control/).waitFor();
    await shot(page, `demo-lid-${ended.state}`);
    await page.mouse.up();
  }
  server.close();
}

/** No file of the server may grow any more, as on a disk that is full. */
async function fullDisk(page, folder, {pid}) {
  await armed(page);
  await aim(page, 1, 0.3, 0.5);
  await told(page, (now) => !isThere(now));
  await pressUntil(page, bar(page, /MOVE/), ({activity}) => activity === 'moving');
  const {recording: {name}} = await frame(page), limit = (size) => execFileSync('prlimit', ['--pid', String(pid), `--fsize=${size}:`]);
  limit(statSync(join(folder, `${name}.csv`)).size + 200);
  await told(page, ({recording, activity}) => recording.error !== '' && activity !== 'moving');
  await page.mouse.up();
  await page.locator('#op-banner', {hasText: /NOT RECORDED[^]*The recording failed: File too large\. Motion is held\. Make room/}).waitFor();
  await page.locator('#op-bar').getByText('recording failed').first().waitFor();
  assert.equal(await bar(page, /MOVE/).getAttribute('aria-disabled'), 'true');
  await shot(page, 'demo-full-disk');
  const {time} = await frame(page);
  await told(page, (now) => now.time > time + 0.2 && allExact(now));  // one still looks on
  await page.keyboard.press('x');
  await told(page, ({state}) => state === 'control');
  limit('unlimited');
  await bar(page, /Arm…/).click();
  await page.locator('.arming-dialog', {hasText: 'the last time: File too large; make room on the disk, then arm'}).waitFor();
  await shot(page, 'demo-full-disk-arm');
  await arm(page);
  await told(page, ({state, recording}) => state === 'armed' && recording.error === '');
  await page.locator('#op-banner', {hasText: 'ALL SECTIONS EXACT'}).waitFor();
}

/** From looking on to homing, moving, a closed lid, a full disk, each fault, and back. */
export async function demo(browser) {
  if (!isBuilt) return console.log('demo: skipped: sinew-simulate and sinew-firmware-panel.elf are not built');
  await demonstrated('nottingham-tpcj', async (url, folder, server) => {
    const {page, done} = await look(browser, url);
    assert.equal(await page.locator('#source').innerText(), 'DEVICE · LIVE');
    await shot(page, 'demo-first');
    await bar(page, /Take control/).click();
    await home(page, folder);
    await arm(page);
    await moves(page);
    await closedLid(url, page);
    await fullDisk(page, folder, server);
    await insertsAndRetracts(page);
    await secondPage(browser, url, page);
    await faults(page, url);
    await done(/409/);
  });
}

/** The firmware has the table of another motor than the file says. */
export async function demo_wrong_robot(browser) {
  if (!isBuilt) return console.log('demo_wrong_robot: skipped: sinew-simulate and sinew-firmware-panel.elf are not built');
  const folder = mkdtempSync(join(tmpdir(), 'sinew-robot-')), robot = join(folder, 'other.yaml');
  writeFileSync(robot, `${readFileSync(new URL('../../robots/nottingham-tpcj.yaml', import.meta.url), 'utf8')}motor: {lead: 2 mm, counts: 2048}\n`);
  await demonstrated(robot, async (url) => {
    const {page, done} = await look(browser, url);
    await bar(page, /Take control/).click();
    await bar(page, /Arm…/).click();
    await page.locator('.arming-dialog', {hasText: "the firmware has another robot's table"}).waitFor();
    assert.ok(await page.getByRole('button', {name: 'Hold 1 s to arm'}).isDisabled());
    await shot(page, 'demo-wrong-robot');
    await done(/409/);
  });
  rmSync(folder, {recursive: true});
}
