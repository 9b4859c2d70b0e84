// Jogging on the screen Operate, by pad, fingers and gamepad; Relax all; what is around the arm; diagrams after sections that are not exact, and curved ones.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {audit, blank, differs, drawn, fits, serve, shot, sinew} from './harness.mjs';
import {answered, arrived, bar, bends, control, degree, device, frame, operated, pause, see, sizes, textOf, themes, until, word} from './operating.mjs';
import {framer} from './stand_in.mjs';

const pad = (page, name) => page.locator('#op-jog').getByRole('button', {name});
const target = async (page, section) => (await frame(page)).sections[section].target;
const near = (found, wanted, by, what) => assert.ok(Math.hypot(found[0] - wanted[0], found[1] - wanted[1]) <= by, `${what}: ${found} is not ${wanted}`);

/** Holds a button for some milliseconds, or (a slow machine says less in the same time) until something is there. */
async function press(page, button, held) {
  const {x, y, width, height} = await button.boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await (typeof held === 'number' ? pause(held) : held());
  await page.mouse.up();
}

/** The pad by pointer and keys, in both frames; large enough for gloves; remembered; not on a phone. */
export async function jog_pad(browser, url) {
  const {page, done} = await see(browser, url, 'nottingham-tpcj', '', {locale: 'en'});
  await page.keyboard.press('j');
  await page.locator('#op-jog').waitFor();
  for (const one of await page.locator('#op-jog button:visible').all()) {
    const {width, height} = await one.boundingBox();
    assert.ok(width >= 60 && height >= 60, `${await one.innerText()} is ${width} × ${height}`);
  }
  await answered(page, () => pad(page, 'target +β₁').click());
  near(await target(page, 0), [0.1 * degree, 0], 1e-9, 'a tap is a tenth of a degree');
  await page.locator('#op-jog .middle').click();
  await drawn(page);
  assert.equal(await page.locator('#op-jog .middle').innerText(), 'S2');
  await press(page, pad(page, 'target −β₂'), () => until(page, (bend) => window.__sinew.operate.frame.sections[1].target[1] < bend, -1 * degree));
  await pause(300);  // for the last answer
  const [x, y] = await target(page, 1);
  assert.ok(x === 0 && y < -1 * degree && y > -16 * degree, `held it goes on: ${y / degree}°`);
  await pause(200);
  near(await target(page, 1), [x, y], 1e-12, 'released it stays');
  await pad(page, 'target +β₁').focus();
  await answered(page, () => page.keyboard.press('ArrowUp'));
  near(await target(page, 1), [x, y + 0.1 * degree], 1e-9, 'an arrow on the pad');
  await answered(page, () => page.keyboard.press('Enter'));
  near(await target(page, 1), [x + 0.1 * degree, y + 0.1 * degree], 1e-9, 'Enter on a button');
  // the tip: the camera looks along z, so with +β₂ up +β₁ is to the left
  await pad(page, 'Tip').click();
  await page.locator('#op-jog h2', {hasText: 'Jog the tip: S5'}).waitFor();
  await until(page, () => window.__sinew.operate.steer() !== null);
  await answered(page, () => pad(page, 'target right').click());
  const right = await target(page, 4);
  assert.ok(right[0] < 0 && Math.abs(right[1]) < 1e-3 * -right[0], `right is −β₁ with +β₂ up: ${right}`);
  assert.ok(Math.abs(right[0] + 0.1 * degree / 4) < 1e-9, 'four joints turn the tip four times as far as one bends');
  await answered(page, () => pad(page, 'target left').click());
  for (const theme of themes) {
    await page.emulateMedia({colorScheme: theme});
    await drawn(page);
    await shot(page, `jog-tip-${theme}`);
    await audit(page, `pad ${theme}`);
  }
  await fits(page);
  await page.keyboard.press('v');
  await page.keyboard.press('v');
  await page.keyboard.press('v');
  await page.locator('.view-tools [aria-pressed=true]:text("Full")').waitFor();
  await shot(page, 'jog-full');
  await page.keyboard.press('v');
  await page.reload();
  await operated(page, 0);
  await page.locator('#op-jog h2', {hasText: 'Jog the tip'}).waitFor();  // as it was left
  await pad(page, 'Section').click();
  await shot(page, 'jog-section');
  await page.setViewportSize({width: 800, height: 700});
  await fits(page);
  await shot(page, 'jog-800');
  await page.setViewportSize({width: 390, height: 844});
  assert.ok(await page.locator('#op-jog').isHidden() && await page.locator('.jog-opener').isHidden(), 'a phone looks on');
  await page.setViewportSize({width: 1280, height: 800});
  await pad(page, 'Fold').click();
  await page.locator('#op-jog').waitFor({state: 'hidden'});
  assert.ok(await page.locator('.jog-opener').evaluate((one) => one === document.activeElement || one.offsetHeight >= 60));
  await done();
}

/** With a camera the picture is turned as it sits; a gamepad and the pad say the same. */
export async function jog_camera(browser, url) {
  const {page, done} = await blank(browser, {locale: 'en'});
  await page.addInitScript(() => {
    localStorage.setItem('sinew-jog-pad', 'open');
    localStorage.setItem('sinew-jog-frame', 'tip');
    localStorage.setItem('sinew-camera-turn', '90');
    window.__pad = {connected: true, axes: [0, 0, 0, 0], buttons: Array.from({length: 16}, () => ({pressed: false}))};
    navigator.getGamepads = () => [window.__pad];
    navigator.mediaDevices.enumerateDevices = () => Promise.resolve([{kind: 'videoinput'}]);
  });
  await page.goto(`${url}#robot=nottingham-neutral&screen=operate&inputs=0,0,0,0,0,0,0,0,0.6,0.7`);
  await operated(page, 0);
  await until(page, () => window.__sinew.operate.steer() !== null);
  // +β₂ to the right: up in the picture is +β₁
  const by = async (act) => {
    const before = await target(page, 4);
    await answered(page, act);
    const after = await target(page, 4);
    return [after[0] - before[0], after[1] - before[1]];
  };
  const up = await by(() => pad(page, 'target up').click()), right = await by(() => pad(page, 'target right').click());
  assert.ok(up[0] > 0.9 * 0.1 * degree && Math.abs(up[1]) < 0.1 * up[0], `up: ${up}`);
  assert.ok(right[1] > 0.9 * 0.1 * degree && Math.abs(right[0]) < 0.1 * right[1], `right: ${right}`);
  await shot(page, 'jog-camera');
  const stick = await by(async () => {  // it pushes as long as it is held
    const [from] = await target(page, 4);
    await page.evaluate(() => { window.__pad.axes = [0, 0, 0, -1]; });
    await until(page, (before) => window.__sinew.operate.frame.sections[4].target[0] !== before, from);
    await page.evaluate(() => { window.__pad.axes = [0, 0, 0, 0]; });
  });
  assert.ok(stick[0] > 0 && Math.abs(stick[1]) < 0.1 * stick[0], `a stick pushes as the pad does: ${stick}`);
  await done();
}

/** A device: no target without control, and nothing but the target changes; Advance and Back are motions, held. */
export async function jog_device(browser, url) {
  const {stand, page, done} = await control(browser, url), {calls, said} = stand;
  await page.addInitScript(() => undefined);
  await page.keyboard.press('j');
  await pad(page, 'target +β₁').click();
  await page.locator('#op-notice', {hasText: 'take control to set a target'}).waitFor();
  await press(page, pad(page, /Advance/), 150);
  await page.locator('#op-notice', {hasText: 'take control first'}).waitFor();
  assert.deepEqual(said, [], 'nothing is asked without control');
  await bar(page, /Take control/).click();
  await arrived(stand, () => calls('lease').length > 1);
  await press(page, pad(page, 'target +β₁'), () => arrived(stand, () => calls('target').length > 3 && calls('target').at(-1).body.bends[0][0] > bends[0][0] + 1 * degree));
  await until(page, () => !window.__sinew.operate.subject.control.isAiming);  // the last one waited for the one before
  assert.deepEqual([...new Set(said.map(({call}) => call))].sort(), ['lease', 'target'], 'jogging moves nothing');
  const last = calls('target').at(-1).body.bends, count = calls('target').length;
  near(last[0], [last[0][0], bends[0][1]], 1e-6, 'along one axis');
  assert.ok(last[0][0] > bends[0][0] + 1 * degree);
  await pause(200);
  assert.equal(calls('target').length, count, 'released it asks no more');
  await press(page, pad(page, /Advance/), 150);
  await page.locator('#op-notice', {hasText: 'arm first'}).waitFor();
  assert.equal(calls('advance').length, 0);
  await page.evaluate(() => { document.getElementById('op-notice').hidden = true; });
  stand.push({...stand.frame, state: 'armed', armed_left: 60});
  await bar(page, /MOVE/).waitFor();
  for (const [name, call] of [[/Advance/, 'advance'], [/Back/, 'retract']]) {
    await press(page, pad(page, name), () => arrived(stand, () => calls(call).filter(({body}) => body.held).length >= 2));
    await arrived(stand, () => calls(call).at(-1)?.body.held === false);
  }
  await shot(page, 'jog-device');
  await pad(page, 'target −β₁').focus();
  await page.keyboard.down('ArrowLeft');
  await pause(500);
  const holds = calls('hold').length;
  await page.keyboard.press(' ');  // Hold comes first on the pad, too
  await arrived(stand, () => calls('hold').length === holds + 1);
  await page.evaluate(() => window.dispatchEvent(new Event('blur')));
  const blurred = calls('target').length;
  await pause(250);
  assert.ok(calls('target').length <= blurred + 1, 'a lost focus ends a push');
  await page.keyboard.up('ArrowLeft');
  await fits(page);
  await done();
}

/** Two fingers turn φ; one that waits for the other sets no target; what is left drags nothing. */
export async function jog_twist(browser, url) {
  const {page, done} = await see(browser, url, 'nottingham-neutral', '&inputs=0.8,0,0,0,0,0,0,0,0,0', {hasTouch: true}), touch = await page.context().newCDPSession(page);
  const {x, y, width, height} = await page.locator('.plot-of').first().boundingBox(), middle = [x + width / 2, y + height / 2];
  const fingers = (...angles) => angles.map((angle, id) => ({id, x: middle[0] + 70 * Math.cos(angle), y: middle[1] - 70 * Math.sin(angle)}));
  const send = (type, touchPoints) => touch.send('Input.dispatchTouchEvent', {type, touchPoints});
  const [a, b] = [0.5, 0.5 + Math.PI];
  await send('touchStart', fingers(a));
  await send('touchStart', fingers(a, b));
  await pause(200);
  near(await target(page, 0), [0.8, 0], 1e-9, 'two fingers set nothing');
  await answered(page, async () => { for (let i = 1; i <= 10; ++i) await send('touchMove', fingers(a + 0.05 * i, b + 0.05 * i)); });
  await until(page, () => Math.abs(Math.atan2(window.__sinew.operate.frame.sections[0].target[1], window.__sinew.operate.frame.sections[0].target[0]) - 0.5) < 0.02);
  const turned = await target(page, 0);
  assert.ok(Math.abs(Math.hypot(...turned) - 0.8) < 1e-9, 'θ stays');
  await shot(page, 'jog-twist');
  await send('touchEnd', fingers(a + 0.5));
  await send('touchMove', fingers(a + 1.5));
  await pause(150);
  near(await target(page, 0), turned, 1e-9, 'the finger that is left drags nothing');
  await send('touchEnd', []);
  await send('touchStart', fingers(a));  // a tap
  await answered(page, () => send('touchEnd', []));
  near(await target(page, 0), [Math.cos(a) * Math.hypot(...await target(page, 0)), Math.sin(a) * Math.hypot(...await target(page, 0))], 0.02, 'a tap sets it');
  await send('touchStart', fingers(b));  // a drag
  await answered(page, async () => { for (let i = 1; i <= 5; ++i) await send('touchMove', fingers(b + 0.05 * i)); });
  const dragged = await target(page, 0);
  assert.ok(Math.abs(Math.atan2(dragged[1], dragged[0]) - (b + 0.25 - 2 * Math.PI)) < 0.05, 'one finger drags');
  await send('touchEnd', []);
  await page.mouse.dblclick(...middle);
  await page.locator('.numbers-dialog[open]', {hasText: 'Target of S1'}).waitFor();
  await page.keyboard.press('Escape');
  await done();
}

/** Relax all: held for a second, the most tense first, one after the other; it stops at once when it is let go, or held by another page. */
export async function jog_relax_all(browser, url) {
  const {stand, make, page, done} = await control(browser, url), {calls, refusals} = stand;
  const tense = [3, 9, 1, 12, 2], order = [3, 1, 0, 4, 2];
  stand.push(await make(bends, null, {each: (i) => ({tension: [tense[i], 1, 1]})}));
  await bar(page, /Take control/).click();
  await arrived(stand, () => calls('lease').length > 1);
  await page.locator('#op-view').focus();
  await page.keyboard.press('l');
  const all = page.locator('.drawer').getByRole('button', {name: 'Relax all'}), box = await all.boundingBox();
  await all.click();  // not for long enough
  await pause(1200);
  assert.equal(calls('relax').length, 0);
  const sections = () => calls('relax').filter(({body}) => body.held).map(({body}) => body.section).filter((one, i, list) => one !== list[i - 1]);
  await page.mouse.move(box.x + 20, box.y + 15);
  await page.mouse.down();
  await pause(700);
  assert.equal(calls('relax').length, 0, 'not before a second');
  for (let i = 0; i < 5; ++i) {
    await arrived(stand, () => sections().length === i + 1);
    await pause(150);
    if (i === 1) await shot(page, 'jog-relax-all');
    refusals.relax = {code: 'done', message: 'it is done: release the button', isOnce: true};
    await arrived(stand, () => calls('relax').some(({body}) => !body.held && body.section === order[i]));
  }
  await page.locator('.relax-all', {hasText: 'all are slack'}).waitFor();
  assert.deepEqual(sections(), order);
  await page.mouse.up();
  await pause(150);
  const count = calls('relax').length;
  // let go
  await page.mouse.down();
  await arrived(stand, () => calls('relax').length > count + 1);
  await page.mouse.up();
  await arrived(stand, () => calls('relax').at(-1).body.held === false);
  await pause(300);
  assert.deepEqual(sections().slice(5), [3], 'no section after it was let go');
  await page.locator('.relax-all', {hasText: 'stopped with 4 to go'}).waitFor();
  // held from another page
  await page.mouse.down();
  await arrived(stand, () => sections().length === 7 || calls('relax').at(-1).body.held);
  refusals.relax = {code: 'release_first', message: 'motion was stopped: release the button, then hold it again', isOnce: true};
  await page.locator('#op-notice', {hasText: 'motion was stopped'}).waitFor();
  await pause(400);
  assert.ok(!calls('relax').at(-1).body.held && !sections().slice(6).some((one) => one !== 3), 'Hold of another page ends it');
  await page.mouse.up();
  await done();
}

/** The tube by the stage, the ghost, the scene of a plan, by WebGL. */
export async function jog_pictures(browser, url) {
  const {stand, make} = await device(url, 'nottingham-tpcj');
  for (const [width, height] of sizes) {
    const {page, done} = await blank(browser, {width, height, theme: width < 720 ? 'dark' : 'light'}), at = async (stage) => stand.push({...await make(bends, [0, 0, 3e-4, -4e-4, 0], {each: (i) => (i === 4 ? {target: [0.3, -0.2]} : {})}), stage, insertion: stage, stage_target: stage});
    const telling = setInterval(() => stand.push(stand.frame), 50), view = () => page.locator('#op-view').screenshot();
    await at(0);
    await page.goto(stand.url);
    await until(page, () => document.querySelector('#op-view canvas') !== null && document.querySelectorAll('#op-view .label.tube:not([hidden])').length === 1);
    await pause(300);
    const before = await view();
    await shot(page, `jog-tube-0-${width}`);
    await at(0.06);
    await until(page, () => window.__sinew.operate.frame.insertion === 0.06);
    await pause(300);
    differs(await view(), before, 'the stage');
    await shot(page, `jog-tube-60-${width}`);
    if (width > 720) for (const name of ['top', 'tip', 'full']) {
      await page.keyboard.press('v');
      await pause(300);
      await shot(page, `jog-tube-${name}`);
    }
    clearInterval(telling);
    await done(/409|ERR_/);
  }
  stand.close();
  const {is_built} = await (await fetch(new URL('/api/plans', url))).json();
  if (is_built) await scene(browser);
}

/** Of a plan for the robot that is open, and of no other. */
async function scene(browser) {
  const folder = mkdtempSync(join(tmpdir(), 'sinew-jog-')), file = (name) => join(folder, name);
  writeFileSync(file('wall.yaml'), execFileSync(sinew, ['new', 'scene']));
  execFileSync(sinew, ['plan', file('wall.yaml'), '-o', file('wall.csv'), '-q']);
  const own = await serve('--scene', file('wall.yaml'), '--plan', file('wall.csv'));
  const {page, done} = await see(browser, own.url, 'nottingham-tpcj', '&inputs=0.1,0,0,0.1,0,0,0,0,0,0');
  await until(page, () => document.querySelector('#op-view canvas') !== null);
  await pause(800);
  await shot(page, 'jog-scene');
  const before = await page.locator('#op-view').screenshot();
  await page.keyboard.press('v');
  await pause(300);
  differs(await page.locator('#op-view').screenshot(), before, 'from above');
  await shot(page, 'jog-scene-top');
  await page.locator('#robot').selectOption('three-arcs');
  await until(page, () => window.__sinew.operate.frame?.sections.length === 3);
  await pause(300);
  await shot(page, 'jog-no-scene');
  await done();
  own.server.kill('SIGINT');
  rmSync(folder, {recursive: true});
}

/** After a section that is not exact: its outline, or in words why there is none. */
export async function jog_outline(browser, url) {
  const {stand, make} = await device(url, 'nottingham-tpcj'), lines = (page, section) => page.locator('.diagram').nth(section).locator('.given').allTextContents();
  stand.push(await make(bends, [0, 7.5e-4, 3e-4, -7e-4, 0]));
  for (const [width, height] of sizes) for (const theme of themes) {
    const {page, done} = await blank(browser, {width, height, theme}), telling = setInterval(() => stand.push(stand.frame), 50);
    await page.goto(stand.url);
    await until(page, () => document.querySelectorAll('.diagram .axes').length > 0);
    if (width > 720) {
      assert.deepEqual(await lines(page, 2), ['given S2']);
      assert.equal(await page.locator('.diagram').nth(2).locator('.outline').count(), 1);
      assert.deepEqual(await lines(page, 3), ['given S3, no outline:', 'itself over-tensioned']);
      assert.deepEqual(await lines(page, 4), ['given S4, no outline:', 'over-tensioned']);
      for (const section of [3, 4]) assert.equal(await page.locator('.diagram').nth(section).locator('.outline').count(), 0);
      assert.match(await page.locator('.plot-of').nth(4).getAttribute('aria-label'), /given S4, no outline: over-tensioned/);
    } else await page.locator('.chips button').nth(4).click();
    await drawn(page);
    await shot(page, `jog-outline-${width}-${theme}`);
    clearInterval(telling);
    await done(/409|ERR_/);
  }
  stand.close();
  // many sections: the words fit their smaller cards
  const {page, done} = await blank(browser);
  await page.goto(`${url}#robot=nottingham-tpcj&screen=operate`);
  await operated(page, 0);
  await page.locator('#chooser').setInputFiles({name: 'arm-8.yaml', mimeType: 'text/yaml', buffer: Buffer.from(textOf('nottingham-tpcj').replace('count: 5', 'count: 8'))});
  await until(page, () => document.querySelectorAll('.section').length === 8 && window.__sinew.operate.frame?.sections.length === 8);
  await page.keyboard.press('3');
  for (let i = 0; i < 3; ++i) await answered(page, () => page.keyboard.press('-'));
  await until(page, () => document.querySelectorAll('.diagram')[3].querySelectorAll('.given').length === 2);
  for (const box of await page.locator('.diagram').nth(3).locator('.given').evaluateAll((all) => all.map((one) => one.getBBox().x + one.getBBox().width - one.ownerSVGElement.clientWidth))) assert.ok(box <= 0, `words are ${box} px too long`);
  await shot(page, 'jog-outline-8');
  await done();
}

/** Curved frontiers, of lengths of constant curvature: hatched on the side they forbid, filled and dashed as straight ones are. */
export async function jog_curves(browser, url) {
  const rows = {exact: [null], slack: [[0, 1.5e-3, 0, 0, 0]], over: [[0, -1.5e-3, 0, 0, 0]]};
  for (const [robot, own, info] of [['nottingham-neutral', [[0.8, -0.5], [-1, 0.6], [0.3, 1.2], [1, 0.2], [0.5, 0.5]], {}], ['four-tendon-neutral', [[0.8, -0.5], [-1, 0.6], [0.3, 1.2], [1, 0.2], [0.5, 0.5]], {tendons: 4}], ['nottingham-tpcj', bends, {}]]) {
    const {stand} = await device(url, robot, info), make = await framer(url, textOf(robot));
    for (const [name, [slack]] of Object.entries(rows)) {
      const told = await make(own, slack, {model: 'pcc'});
      assert.ok(told.sections.every((one) => one.frontiers.every(({curve}) => curve.length > 10)), 'curves are asked for');
      stand.push(told);
      for (const [width, height] of name === 'slack' ? sizes : sizes.slice(0, 1)) for (const theme of name === 'slack' ? themes : ['light']) {
        const {page, done} = await blank(browser, {width, height, theme}), telling = setInterval(() => stand.push(stand.frame), 50);
        await page.goto(stand.url);
        await until(page, () => document.querySelectorAll('.diagram .axes').length > 0);
        if (width < 720) await page.locator('.chips button').nth(1).click();
        else await sides(page, told.sections);
        await drawn(page);
        await shot(page, `jog-curves-${robot}-${name}-${width}-${theme}`);
        const second = page.locator('.diagram').nth(1);
        assert.equal(await second.locator('.free').count() > 0, name === 'slack', `${name}: what is free`);
        assert.equal(await second.locator('.empty').count() > 0, name === 'over', `${name}: what is forbidden`);
        if (width > 720) assert.equal(await word(page, 1), {exact: 'EXACT', slack: 'SLACK', over: 'OVER-TENSIONED'}[name]);
        await fits(page);
        clearInterval(telling);
        await done(/409|ERR_/);
      }
    }
    stand.close();
  }
}

/** Hatch lines begin on a frontier, and end where its tendon is too short: farther from what it pulls towards. */
async function sides(page, sections) {
  const wrong = await page.evaluate((all) => all.flatMap(({frontiers}, i) => {
    const drawnOf = [...document.querySelectorAll('.diagram')[i].querySelectorAll('.frontier')];
    return drawnOf.flatMap((group, k) => {
      const hatch = group.querySelector('.hatch').getAttribute('d');
      if (!hatch) return [`S${i + 1} tendon ${k + 1}: no hatch`];
      const curve = group.querySelector('.line').points, ends = [...hatch.matchAll(/M([\d.-]+) ([\d.-]+)l([\d.-]+) ([\d.-]+)/g)].map((found) => found.slice(1).map(Number));
      const [a, b] = [curve.getItem(0), curve.getItem(curve.numberOfItems - 1)], left = (x, y) => (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
      return ends.filter(([x, y, u, v]) => left(x + u, y + v) < left(x, y)).map(() => `S${i + 1} tendon ${k + 1}: hatched on the free side of ${frontiers.length}`);
    });
  }), sections);
  assert.deepEqual([...new Set(wrong)], []);
}
