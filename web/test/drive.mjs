// Plans that are driven: from the screen Trajectory to Operate, by a stand-in for a device and by the arm of sliders.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {audit, blank, differs, drawn, fits, linked, shot} from './harness.mjs';
import {framer, standIn} from './stand_in.mjs';
import {plans} from './ways.mjs';

const text = readFileSync(new URL('../../robots/nottingham-tpcj.yaml', import.meta.url), 'utf8');
const pause = (ms) => new Promise((next) => setTimeout(next, ms));
const bar = (page, name) => page.locator('#op-bar').getByRole('button', {name});
const readings = async (page, wanted) => {
  for (let tries = 0, said = ''; !wanted.test(said); ++tries) {
    assert.ok(tries < 300, `${wanted}: ${said}`);
    if (tries > 0) await pause(50);
    said = await page.locator('#op-tip').innerText();
  }
};

const until = async (page, is, ...values) => {
  for (let tries = 0; !await page.evaluate(is, ...values); ++tries) {
    assert.ok(tries < 1200, `it did not come: ${is}`);
    await pause(tries < 20 ? 10 : 100);
  }
  await drawn(page);
};
const arrived = async (is) => {
  for (let tries = 0; !is(); ++tries) {
    assert.ok(tries < 1500, `it was not said: ${is}`);
    await pause(20);
  }
};

/** A page at a plan of a server that has a device of the same robot, or of another one. */
async function see(browser, name, {isSame = true, ...options} = {}) {
  const {url, handles} = await plans(), told = await (await fetch(new URL(`/api/plans/${handles[name]}`, url))).json();
  const stand = await standIn(url, 'nottingham-tpcj', text, {robot: 'driven', file: isSame ? told.robot.robot : 'other'}), make = await framer(url, text);
  stand.push({...await make(Array(5).fill([0, 0])), stage: 0, insertion: 0, stage_target: 0, plan: null});
  const {page, done} = await blank(browser, options), telling = setInterval(() => stand.push(stand.frame), 50);
  await page.goto(`${stand.url}#plan=${handles[name]}`);
  await until(page, () => Number(document.documentElement.dataset.drawn ?? -1) >= 0);
  /** The arm at a step of the plan. */
  const to = async (place, more = {}, plan = {}) => {
    const {bends, stage} = stand.plan.steps[Math.floor(place)];
    stand.push({...stand.frame, ...await make(bends), control: stand.control(), state: 'armed', armed_left: 60, stage, insertion: stage, stage_target: stage, plan: stand.atStep(place, plan), ...more});
  };
  return {stand, make, to, told, page, done: async () => {
    clearInterval(telling);
    await done(/409|ERR_/);
    stand.close();
  }};
}

const driver = (page) => page.locator('#way-tools, #way-tabs').getByRole('button', {name: 'Drive…'});

/** To the device with control, armed, off the path and on it, there and back, paused, dropped; what is asked of it each time. */
export async function drive_device(browser) {
  const {stand, to, told, page, done} = await see(browser, 'wall'), {calls} = stand, last = told.steps.length - 1;
  await driver(page).click();
  await arrived(() => calls('plan').length === 1);
  const {body} = calls('plan')[0];
  assert.equal(body.robot, told.robot.robot);
  assert.equal(body.name, 'wall');
  assert.equal(body.steps.length, last + 1);
  assert.deepEqual(body.steps[40].bends, told.steps[40].configuration.map((pair) => pair.map((value) => Number(value.toPrecision(12)))));
  assert.deepEqual(body.clearance, told.check.steps.map(({clearance}) => Number(clearance.toPrecision(12))));
  assert.equal(await page.evaluate(() => document.body.dataset.screen), 'operate');
  assert.match(body.lease, /^secret-/, 'control was taken for it');
  // off the path, not inserted: first to the first step
  const off = {bend: 0.043, section: 3, stage: 0, to_first: true, message: 'off the path by 2.5° in S4 and 0.0 mm of the stage: Move to the first step'};
  await to(0, {}, {off_path: off, clearance: null});
  await bar(page, /MOVE.*first step/).waitFor();
  await until(page, () => window.__sinew.operate.subject.tips.length > 0);
  await readings(page, /plan step\s+off path\s+clearance\s+–/);
  await shot(page, 'drive-off');
  await page.locator('#op-view').focus();
  await page.keyboard.down('m');
  await arrived(() => calls('move').length > 1);
  await page.keyboard.up('m');
  await arrived(() => calls('move').at(-1).body.held === false);
  assert.equal(calls('follow').length, 0);
  const names = stand.said.map(({call}) => call), target = names.indexOf('target');
  assert.ok(target >= 0 && target < names.indexOf('move'), 'the target is known before anything moves');
  assert.deepEqual(calls('target')[0].body.bends, body.steps[0].bends);
  // along it
  await to(0);
  await bar(page, /FOLLOW PLAN/).waitFor();
  assert.equal(await bar(page, /Back/).getAttribute('aria-disabled'), 'true');
  await page.keyboard.down('m');
  await arrived(() => calls('follow').length > 2);
  await page.keyboard.up('m');
  await arrived(() => calls('follow').at(-1).body.held === false);
  assert.ok(calls('follow').every(({body: {back}}) => !back));
  await to(200.5);
  await until(page, () => /200 of/.test(document.getElementById('op-tip').innerText));
  await readings(page, new RegExp(`plan step\\s+200 of ${last}\\s+clearance\\s+\\d\\.\\d mm`));
  await audit(page, 'drive');
  await shot(page, 'drive-along');
  const before = calls('follow').length, box = await bar(page, /Back/).boundingBox();
  await page.mouse.move(box.x + 20, box.y + 10);
  await page.mouse.down();
  await arrived(() => calls('follow').length > before + 2);
  await page.mouse.up();
  await arrived(() => calls('follow').at(-1).body.held === false);
  assert.ok(calls('follow').slice(before).every(({body: {back}}) => back === true), 'a release says which way, too');
  await page.keyboard.down('b');
  await pause(150);
  await page.keyboard.press('Escape');
  await arrived(() => calls('hold').length === 1);
  await page.keyboard.up('b');
  // inserted and off the path: what is locked says the way out, and asks nothing
  const lost = {...off, to_first: false, message: 'off the path by 6.0° in S4 and 0.0 mm of the stage: hold Retract until it is out, then Move to the first step'};
  await to(200, {}, {off_path: lost, clearance: null});
  await bar(page, /FOLLOW PLAN.*off path/).waitFor();
  await pause(200);  // an end is told twice
  const asked = calls('follow').length;
  await page.keyboard.press('m');
  await page.locator('#op-notice', {hasText: 'hold Retract until it is out'}).waitFor();
  await shot(page, 'drive-lost');
  await page.keyboard.press('w');
  await page.locator('#op-notice', {hasText: 'drop the plan first'}).waitFor();
  assert.equal(calls('follow').length, asked);
  await page.keyboard.down('r');
  await arrived(() => calls('retract').length > 1);
  await page.keyboard.up('r');
  await to(last);
  await bar(page, /FOLLOW PLAN.*at its end/).waitFor();
  // a page that is loaded anew knows it by the device
  await page.reload();
  await until(page, () => window.__sinew?.operate?.subject?.tips?.length > 0);
  stand.forgetLease();
  await page.keyboard.press('Alt+2');
  await bar(page, /Take control/).click();
  await bar(page, /Drop plan/).click();
  await arrived(() => calls('plan').length === 2);
  assert.equal(calls('plan')[1].body.steps, undefined);
  await bar(page, /Straighten/).waitFor();
  assert.equal(await bar(page, /Drop plan/).count(), 0);
  await done();
}

/** What cannot be driven says why; a lease that another page has is waited for; a refusal is told. */
export async function drive_refused(browser) {
  const other = await see(browser, 'wall', {isSame: false});
  assert.equal(await driver(other.page).getAttribute('aria-disabled'), 'true');
  await driver(other.page).click({force: true});
  await other.page.locator('#toast', {hasText: 'another robot than nottingham-tpcj'}).waitFor();
  assert.deepEqual(other.stand.said, []);
  await other.done();
  const touch = await see(browser, 'touch');
  await touch.page.keyboard.press('v');
  await touch.page.locator('#toast', {hasText: 'the plan touches'}).waitFor();
  assert.deepEqual(touch.stand.said, []);
  await touch.done();
  const {stand, page, done} = await see(browser, 'wall'), {calls} = stand;
  stand.takenElsewhere();
  stand.refusals.lease = {code: 'lease_taken', message: 'another page controls since 10:41; Hold works from here, too'};
  stand.refusals.plan = {code: 'too_far', message: 'step 12: 7 mm from the one before'};
  await driver(page).click();
  await page.locator('#op-notice', {hasText: 'another page controls'}).waitFor();
  assert.equal(calls('plan').length, 0);
  await readings(page, /plan\s+waits for control/);
  delete stand.refusals.lease;
  stand.forgetLease();
  await bar(page, /Take control/).click();
  await page.locator('#op-notice', {hasText: 'step 12: 7 mm'}).waitFor();
  await pause(200);
  assert.equal(calls('plan').length, 1, 'what is refused is not asked again');
  assert.equal(await bar(page, /FOLLOW/).count(), 0);
  await done();
}

/** Without a device the arm of sliders goes along it: by button, keys, at its speed. */
export async function drive_sliders(browser) {
  const {url, handles} = await plans(), {page, done} = await blank(browser);
  await page.goto(`${url}#plan=${handles.wall}`);
  await until(page, () => Number(document.documentElement.dataset.drawn ?? -1) >= 0);
  await driver(page).click();
  await bar(page, /FOLLOW PLAN/).waitFor();
  await until(page, () => window.__sinew.operate.subject.tips.length > 0);
  assert.equal(await page.locator('#source').innerText(), 'SLIDERS');
  await readings(page, /plan step\s+0 of/);
  const step = () => page.evaluate(() => window.__sinew.operate.subject.plan.frame.step);
  await page.keyboard.down('m');
  await until(page, () => window.__sinew.operate.subject.plan.frame.step > 60);
  await page.keyboard.up('m');
  const there = await step(), stage = await page.evaluate(() => window.__sinew.operate.subject.stages.now);
  await pause(300);
  assert.equal(await step(), there, 'a release stops it');
  const {steps} = await (await fetch(new URL(`/api/plans/${handles.wall}`, url))).json();
  assert.ok(stage >= steps[there].stage && stage <= steps[there + 1].stage);
  const [a, b] = [steps[there], steps[there + 1]], targets = await page.evaluate(() => window.__sinew.operate.subject.targets()), share = (stage - a.stage) / (b.stage - a.stage);
  targets.forEach((pair, i) => pair.forEach((value, k) => assert.ok(Math.abs(value - a.configuration[i][k] - share * (b.configuration[i][k] - a.configuration[i][k])) < 1e-9, 'straight between two steps')));
  await shot(page, 'drive-sliders');
  await audit(page, 'drive sliders');
  // loaded anew it is where it was
  const place = () => page.evaluate(() => window.__sinew.operate.subject.plan?.place), before = [await place(), await page.evaluate(() => window.__sinew.operate.subject.targets())], address = await linked(page);
  assert.match(address, new RegExp(`screen=operate.*plan=${handles.wall}&step=${before[0].toFixed(3).replace(/\.?0*$/, '')}`));
  for (const to of [address, address.replace(handles.wall, 'ffffffffffffffff'), address.replace(/step=[\d.]+/, 'step=-1e9')]) {
    await page.goto('about:blank');
    await page.goto(to);
    if (to.includes('ffffffff')) await page.locator('#plan-verdict', {hasText: 'a plan that this server does not have'}).waitFor();
    else await until(page, () => window.__sinew?.operate?.subject?.tips?.length > 0 && !!window.__sinew.operate.frame);
    if (to === address) assert.deepEqual([await place(), await page.evaluate(() => window.__sinew.operate.subject.targets())].flat(3).map((value) => value.toFixed(3)), before.flat(3).map((value) => value.toFixed(3)));
  }
  assert.equal(await place(), 0);
  await page.goto('about:blank');
  await page.goto(address);
  await until(page, () => window.__sinew?.operate?.subject?.tips?.length > 0 && !!window.__sinew.operate.frame);
  await page.keyboard.down('b');
  await until(page, (from) => window.__sinew.operate.subject.plan.frame.step < from - 20, there);
  await page.evaluate(() => window.dispatchEvent(new Event('blur')));
  await pause(100);
  const blurred = await step();
  await pause(300);
  assert.equal(await step(), blurred, 'so does a window without the focus');
  await page.keyboard.up('b');
  await page.evaluate(() => { window.__sinew.operate.subject.plan.place = 287.5; });
  const box = await bar(page, /FOLLOW PLAN/).boundingBox();
  await page.mouse.move(box.x + 30, box.y + 20);
  await page.mouse.down();
  await bar(page, /FOLLOW PLAN.*at its end/).waitFor();
  await page.mouse.up();
  await bar(page, /Drop plan/).click();
  await bar(page, /Straighten/).waitFor();
  assert.doesNotMatch(await linked(page), /plan=/);
  await done(/404/);
}

/** By WebGL, at both sizes and in both themes: the way of the tip, the arm on it, where it leads. */
export async function drive_pictures(browser) {
  for (const [width, height] of [[1280, 800], [390, 844]]) {
    const {stand, to, page, done} = await see(browser, 'wall', {width, height});
    if (width < 720) {
      await driver(page).click({force: true});
      await page.locator('#toast', {hasText: 'a phone looks on'}).waitFor();
      assert.deepEqual(stand.said, []);
      await done();
      continue;
    }
    await driver(page).click();
    await arrived(() => stand.plan !== null);
    await to(120.25);
    await until(page, () => window.__sinew.operate.subject.tips.length > 0 && /120 of/.test(document.getElementById('op-tip').innerText));
    await pause(300);
    for (const theme of ['light', 'dark']) {
      await page.emulateMedia({colorScheme: theme});
      await drawn(page);
      await shot(page, `drive-${width}-${theme}`);
    }
    const view = () => page.locator('#op-view').screenshot(), before = await view();
    await to(240);
    await until(page, () => /240 of/.test(document.getElementById('op-tip').innerText));
    await pause(300);
    differs(await view(), before, 'farther along');
    await page.keyboard.press('v');
    await page.keyboard.press('v');
    await page.keyboard.press('v');
    await pause(300);
    await shot(page, 'drive-full');
    await fits(page);
    await done();
  }
  const {url, handles} = await plans();
  for (const theme of ['light', 'dark']) {
    const {page, done} = await blank(browser, {width: 390, height: 844, theme});
    await page.goto(`${url}#plan=${handles.wall}`);
    await until(page, () => Number(document.documentElement.dataset.drawn ?? -1) >= 0);
    await driver(page).click();
    await bar(page, /FOLLOW PLAN/).waitFor();
    await until(page, () => window.__sinew.operate.subject.tips.length > 0);
    await shot(page, `drive-390-${theme}`);
    for (const target of await page.locator('#op-bar button:visible').all()) assert.ok((await target.boundingBox()).height >= 44);
    await fits(page);
    await done();
  }
}
