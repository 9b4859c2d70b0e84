// The screen Operate: an arm of sliders against `sinew diagram`, and the looks and the safety of a device by a stand-in.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {audit, blank, differs, drawn, fits, linked, looks, open, same, shot, sinew} from './harness.mjs';
import {standIn} from './stand_in.mjs';
import {alarm, answered, arrived, bar, bends, control, degree, device, draws, frame, operated, pause, see, sizes, textOf, themes, until, word} from './operating.mjs';

/** The target by pointer, keys and numbers; the command gives the numbers of the page; the link brings them back. */
export async function operate_sliders(browser, url) {
  const {page, done} = await open(browser, url, 'nottingham-tpcj');
  await page.keyboard.press('Alt+2');
  await operated(page, 0);
  assert.equal(await page.locator('#source').innerText(), 'SLIDERS');
  assert.equal(await page.locator('#op-banner strong').innerText(), 'ALL SECTIONS EXACT');
  const plot = await page.locator('.plot-of').nth(1).boundingBox(), at = (x, y) => [plot.x + plot.width * x, plot.y + plot.height * y];
  await page.mouse.move(...at(0.5, 0.5));
  await page.mouse.down();
  await answered(page, () => page.mouse.move(...at(0.7, 0.4), {steps: 4}));
  await page.mouse.up();
  await until(page, () => Math.abs(window.__sinew.operate.frame.sections[1].point[0] / 0.2044 - 1) < 0.03);
  await page.mouse.move(...at(0.7, 0.4));  // beyond the envelope it stays at its edge
  await page.mouse.down();
  await answered(page, () => page.mouse.move(...at(0.99, 0.4), {steps: 3}));
  assert.equal(await page.locator('.diagram .pull').count(), 1);
  await shot(page, 'operate-beyond');
  await fits(page);
  await page.mouse.up();
  await until(page, (limit) => Math.abs(window.__sinew.operate.frame.sections[1].target[0] - limit) < 1e-9, 24 * degree);
  assert.match(await page.locator('.section .more').nth(1).innerText(), /near limit/);
  await page.locator('.section .type').nth(2).click();
  await page.locator('#typed-0').fill('5 mm');
  await page.keyboard.press('Enter');
  await page.getByText('mm is no unit of angle').waitFor();
  await page.locator('#typed-0').fill('5 deg');
  await answered(page, () => page.keyboard.press('Enter'));
  assert.ok(Math.abs((await frame(page)).sections[2].point[0] - 5 * degree) < 1e-12);
  await page.keyboard.press('4');
  for (let i = 0; i < 3; ++i) await answered(page, () => page.keyboard.press('-'));
  assert.equal(await word(page, 3), 'OVER-TENSIONED');
  assert.match(await page.locator('#op-banner').innerText(), /S4 OVER-TENSIONED by 0\.30 mm[\s\S]*Pay out tendons 1, 2 and 3 by 0\.30 mm/);
  const command = await page.locator('.as-command code').innerText(), words = [...command.matchAll(/"([^"]*)"|(\S+)/g)].map(([, quoted, plain]) => quoted ?? plain);
  const told = JSON.parse(execFileSync(sinew, [...words.slice(1), '--json'], {encoding: 'utf8'})), shown = (await frame(page)).sections[3];
  for (const key of ['class', 'partial', 'conditional', 'word', 'advice', 'near_limit']) assert.equal(shown[key], told[key], key);
  const flat = (part) => [part].flat(3).flatMap((one) => (typeof one === 'object' ? [...one.normal, one.offset] : [one]));
  for (const key of ['point', 'slack', 'amount', 'frontiers', 'margin', 'over_tension']) flat(shown[key]).forEach((value, i) => assert.ok(Math.abs(value - flat(told[key])[i]) < 1e-9, key));
  const link = await linked(page), before = await frame(page);
  await page.goto('about:blank');
  await page.goto(link);
  await operated(page, 0);
  await until(page, () => window.__sinew.operate.frame.sections[3].word === 'OVER-TENSIONED');
  assert.deepEqual((await frame(page)).sections, before.sections);
  await page.keyboard.press('Alt+1');
  await until(page, () => document.documentElement.dataset.rests === document.documentElement.dataset.answers);
  assert.equal(await page.locator('#inputs input:not([type=range])').nth(4).inputValue(), '5.00');
  await done();
}

/** By keys alone. */
export async function operate_keys(browser, url) {
  const {page, done} = await see(browser, url, 'nottingham-neutral');
  await page.keyboard.press('3');
  assert.equal(await page.evaluate(() => document.activeElement.getAttribute('aria-label').slice(0, 2)), 'S3');
  for (const [key, x, y] of [['ArrowRight', 0.1, 0], ['Shift+ArrowUp', 0.1, 1], ['ArrowLeft', 0, 1], ['ArrowDown', 0, 0.9]]) {
    await answered(page, () => page.keyboard.press(key));
    const {point} = (await frame(page)).sections[2];
    assert.ok(Math.hypot(point[0] - x * degree, point[1] - y * degree) < 1e-9, key);
  }
  await page.keyboard.press('Enter');
  await page.locator('.numbers-dialog[open]').waitFor();
  await page.locator('#typed-1').fill('300');
  await page.keyboard.press('Enter');
  await page.getByText('it goes from -192').waitFor();
  await page.keyboard.press('Escape');
  for (let i = 0; i < 2; ++i) await answered(page, () => page.keyboard.press('+'));
  assert.equal(await word(page, 2), 'SLACK');
  await page.keyboard.press('l');
  await page.locator('.drawer', {hasText: 'S3 slack'}).waitFor();
  await shot(page, 'operate-drawer');
  await page.keyboard.press('Escape');
  await page.locator('.drawer').waitFor({state: 'hidden'});
  for (const view of ['Top', 'Tip', 'Full', 'Side']) {
    await page.keyboard.press('v');
    await page.locator(`.view-tools [aria-pressed=true]:text("${view}")`).waitFor();
    assert.equal(await page.locator('#op-cards').isHidden(), view === 'Full', view);
  }
  await page.keyboard.press('?');
  await page.locator('#keys[open]').waitFor();
  await page.keyboard.press('Escape');
  await done();
}

/** Robots of three sections and of many, and parallel ones, which have no such screen. */
export async function operate_robots(browser, url) {
  const {page, done} = await see(browser, url, 'three-arcs');
  await shot(page, 'operate-3');
  for (const count of [8, 12]) {
    const before = await draws(page);
    await page.locator('#chooser').setInputFiles({name: `arm-${count}.yaml`, mimeType: 'text/yaml', buffer: Buffer.from(textOf('nottingham-tpcj').replace('count: 5', `count: ${count}`))});
    await until(page, (of) => document.querySelectorAll('.section').length === of, count);
    await operated(page, before);
    await page.keyboard.press('2');
    for (let i = 0; i < 2; ++i) await answered(page, () => page.keyboard.press('+'));
    await page.keyboard.press('4');
    for (let i = 0; i < 4; ++i) await answered(page, () => page.keyboard.press('-'));
    assert.equal(await page.locator('.section:visible').count(), Math.min(count, 10));
    await shot(page, `operate-${count}`);
    const beyond = await page.locator('.section:visible').evaluateAll((all) => all.filter((one) => one.scrollHeight > one.clientHeight + 1 || one.scrollWidth > one.clientWidth + 1).map((one) => `${one.innerText} ${one.scrollWidth}/${one.clientWidth} ${one.scrollHeight}/${one.clientHeight}`));
    assert.deepEqual(beyond, [], 'a card is too small for what is in it');
    await fits(page);
  }
  await page.locator('#robot').selectOption('3-rfr');
  await page.locator('#screens').waitFor({state: 'hidden'});
  assert.equal(await page.evaluate(() => document.body.dataset.screen), 'design');
  await done();
}

// A device

/** The rows of the table of states: by name what `framer` is given. */
const rows = {
  exact: [null, {}],
  slack: [[0, 0, 7.5e-4, 0, 0], {more: {alarm: alarm(2, 'SLACK', 'Take in tendons 1, 2, 3 by 0.75 mm.')}}],
  'slack-small': [[0, 0, 1e-4, 0, 0], {more: {alarm: alarm(2, 'SLACK', 'Take in tendons 1, 2, 3 by 0.10 mm.')}}],
  over: [[0, 0, 7.5e-4, -7e-4, 0], {more: {alarm: alarm(3, 'OVER-TENSIONED', 'Hold Relax S4 for 1 s.', 1)}, each: (i) => (i === 4 ? {target: [0.2, 0.1], locked: true} : {})}],
  unreachable: [null, {bends: [...bends.slice(0, 2), [0.47, 0.1], ...bends.slice(3)], more: {alarm: alarm(2, 'UNREACHABLE', 'Asked for 26.9°, limit 24°.')}}],
  'near-limit': [null, {bends: [...bends.slice(0, 2), [0.41, 0.1], ...bends.slice(3)], each: (i) => ({near_limit: i === 2})}],
  'full-disk': [null, {more: {state: 'armed', recording: {name: 'now', rows: 812, error: 'No space left on device'}}}],
  noise: [null, {more: {link: 'bad_checksum', message: 'line 3 of 200 failed its checksum', errors: 7, why: 'a line failed its checksum'}}],
  'wrong-table': [null, {each: () => ({word: 'NO DATA'}), more: {age: null, link: 'wrong_table', message: "the firmware has another robot's table", homed: false, rate: 0, alarm: {...alarm(0, 'NO DATA', '', 4)}}}],
  taken: [null, {more: {control: {holder: 3, since: '10:41'}}}],
  'no-data': [[0, 0, 7.5e-4, 0, 0], {each: () => ({word: 'NO DATA'}), more: {age: 4.2, link: 'silent', message: 'the controller does not answer', rate: 0, alarm: {...alarm(0, 'NO DATA', 'Check the cable.', 4)}}}],
};

/** What the picture of a row has that of others has not, and what is said. */
const drawnOf = {slack: '.free', 'slack-small': '.inset .free', over: '.empty', 'partly-slack': '.taut'};
const says = {
  'near-limit': ['#op-banner', 'S3 near the limit.'], 'full-disk': ['#op-banner', 'NOT RECORDED'], noise: ['#op-banner', 'Line 3 of 200 failed its checksum.'],
  'wrong-table': ['#op-banner', "The firmware has another robot's table."], unreachable: ['#op-banner', 'Asked for 26.9°, limit 24°.'], over: ['#op-banner', '1 more: S3 slack'],
};

/** Every row of the table of states, and those of the table of errors that a device tells, at both sizes and in both themes; no two of them look the same to those who see no red or green. */
export async function operate_states(browser, url) {
  // by its place: each frame puts another element there
  const iconOf = async (page, section) => page.screenshot({clip: await page.evaluate((i) => {
    const {x, y, width, height} = document.querySelectorAll('.section')[i].querySelector('h2 .icon').getBoundingClientRect();
    return {x, y, width, height};
  }, section)});
  const {stand, make} = await device(url, 'nottingham-tpcj'), frames = {};
  for (const [name, [slack, {bends: own, ...options}]] of Object.entries(rows)) frames[name] = await make(own ?? bends, slack, options);
  const neutral = await device(url, 'four-tendon-neutral', {tendons: 4}), wide = [[0.8, -0.5], [-1, 0.6], [0.3, 1.2], [1, 0.2], [0.5, 0.5]];
  const partly = (changes) => changes.map((one, i) => (i === 2 ? one.map((value, k) => value + (k % 2 === 0 ? 8e-4 : 0)) : one));
  frames['partly-slack'] = await neutral.make(wide, null, {changes: partly, more: {alarm: alarm(2, 'PARTLY SLACK', 'Take in tendons 1, 3 by 0.80 mm.')}});
  for (const [width, height] of sizes) {
    const {page, done} = await blank(browser, {width, height}), heads = [];
    const vision = await page.context().newCDPSession(page);
    for (const name of Object.keys(frames)) {
      const isNeutral = name === 'partly-slack', of = isNeutral ? neutral.stand : stand;
      of.push(frames[name]);
      if (name === 'exact' || isNeutral) await page.goto(of.url);
      const telling = setInterval(() => of.push(frames[name]), 50);
      await until(page, (words) => JSON.stringify(window.__sinew?.operate?.frame?.sections.map((one) => one.word)) === words && document.querySelectorAll('.diagram .axes').length > 0, JSON.stringify(frames[name].sections.map((one) => one.word)));
      await page.locator('.section.chosen').waitFor();
      if (name === 'no-data') assert.match(await page.locator('.section.chosen .more').innerText(), /4\.\d s old/);
      if (width < 720) await page.locator('.chips button').nth(name === 'over' ? 3 : 2).click();
      await drawn(page);
      for (const [of, selector] of Object.entries(drawnOf)) if (width > 720 && of !== 'slack') assert.equal(await page.locator(`.section .diagram ${selector}`).count() > 0, of === name, `${name}: ${selector}`);
      if (says[name]) await page.locator(says[name][0], {hasText: says[name][1]}).waitFor();
      if (name === 'taken' && width > 720) await bar(page, /VIEW ONLY.*another page controls since 10:41/s).waitFor();
      for (const theme of themes) {
        await page.emulateMedia({colorScheme: theme});
        await drawn(page);
        await shot(page, `operate-${name}-${width}-${theme}`);
        if (name === 'over') await audit(page, `${name} ${width} ${theme}`);
      }
      await fits(page);
      await vision.send('Emulation.setEmulatedVisionDeficiency', {type: 'deuteranopia'});
      if (width > 720) heads.push([name, await iconOf(page, name === 'over' ? 3 : 2)]);
      await vision.send('Emulation.setEmulatedVisionDeficiency', {type: 'none'});
      clearInterval(telling);
    }
    const kinds = heads.filter(([name]) => ['exact', 'slack', 'over', 'unreachable', 'no-data'].includes(name));
    kinds.forEach(([a, first], i) => kinds.slice(i + 1).forEach(([b, second]) => differs(first, second, `${a} and ${b}`)));
    await done(/ERR_INCOMPLETE|ERR_CONNECTION/);
  }
  for (const one of [stand, neutral.stand]) one.close();
}

/** Bars to the side of what is wrong, the way of the last seconds, events by kind and as a file; what pulses does so for nobody who asked for calm. */
export async function operate_details(browser, url) {
  const {stand, make, page, done} = await control(browser, url), [slack, options] = rows.over;
  stand.push(await make(bends, slack, options));
  await until(page, () => window.__sinew.operate.frame.sections[3].word === 'OVER-TENSIONED');
  const bars = (section) => page.locator('.section').nth(section).locator('.tendon').evaluateAll((all) => all.map((one) => {
    const track = one.querySelector('.track').getBoundingClientRect(), fill = one.querySelector('.fill').getBoundingClientRect(), middle = track.left + track.width / 2;
    return [one.querySelector('.value').textContent, fill.width < 1 ? '' : fill.left >= middle - 1 ? 'right' : fill.right <= middle + 1 ? 'left' : 'across'];
  }));
  assert.deepEqual(await bars(2), Array(3).fill(['+0.75 mm', 'right']));
  assert.deepEqual(await bars(3), Array(3).fill(['−0.70 mm', 'left']));
  assert.deepEqual(await bars(0), Array(3).fill(['0.00 mm', '']));
  const pulse = () => page.locator('#op-banner.new').evaluate((one) => getComputedStyle(one).animationName);
  assert.equal(await pulse(), 'pulse');
  await page.emulateMedia({reducedMotion: 'reduce'});
  assert.equal(await pulse(), 'none');
  for (const x of [0.1, 0.15, 0.2]) {
    stand.push(await make([[x, -0.05], ...bends.slice(1)]));
    await until(page, (to) => Math.abs(window.__sinew.operate.frame.sections[0].point[0] - to) < 1e-3, x);
  }
  assert.equal(await page.locator('.diagram').nth(0).locator('.trail').count(), 1);
  assert.equal(await page.locator('.diagram').nth(4).locator('.trail').count(), 0, 'what stands still has no trail');
  stand.push({...stand.frame, link: 'silent', sections: stand.frame.sections.map((one) => ({...one, word: 'NO DATA'}))});
  await until(page, () => window.__sinew.operate.frame.sections[0].word === 'NO DATA');
  stand.push(await make([[-0.1, -0.05], ...bends.slice(1)]));
  await until(page, () => window.__sinew.operate.frame.sections[0].point[0] < 0 && document.querySelectorAll('.diagram')[0].querySelectorAll('.trail').length === 0);  // where it was meanwhile nobody knows
  await page.locator('#op-view').focus();
  await page.keyboard.press('l');
  const entries = page.locator('.drawer ol li');
  assert.equal(await entries.count(), 5);
  assert.match(await entries.first().innerText(), /S4 OVER-TENSIONED/, 'the newest first');
  await page.getByLabel('States').selectOption('slack');
  assert.equal(await entries.count(), 1);
  await page.getByLabel('States').selectOption('');
  const saved = page.waitForEvent('download');
  await page.locator('.drawer').getByRole('button', {name: 'CSV'}).click();
  const csv = readFileSync(await (await saved).path(), 'utf8').split('\n');
  assert.equal(csv[0], 'time[s],clock,kind,text');
  assert.equal(csv[5], '1.000,10:42:17,over,"S4 OVER-TENSIONED 0.70 mm"');
  await done();
}

/** From looking on to moving and back: the lease, the dialog, Move while it is held, and every way in which it ends. */
export async function operate_control(browser, url) {
  const {stand, page, done} = await control(browser, url), {said, calls} = stand;
  assert.equal(await page.locator('#source').innerText(), 'DEVICE · LIVE');
  await page.locator('#op-view').focus();
  await page.keyboard.press('m');
  await page.locator('#op-notice', {hasText: 'take control first'}).waitFor();
  assert.deepEqual(said, [], 'nothing is asked of a device without control');
  await page.keyboard.press(' ');
  await arrived(stand, () => calls('hold').length === 1);  // by anyone
  await bar(page, /Take control/).click();
  await arrived(stand, () => calls('lease').length > 3);
  assert.match(calls('lease').at(-1).body.lease, /^secret-7$/);
  await page.keyboard.press('m');
  await page.locator('#op-notice', {hasText: 'arm first'}).waitFor();
  assert.equal(calls('move').length, 0);
  // targets
  const plot = await page.locator('.plot-of').nth(1).boundingBox();
  await page.mouse.click(plot.x + 0.6 * plot.width, plot.y + 0.4 * plot.height);
  await arrived(stand, () => calls('target').length > 0);
  assert.equal(calls('target').at(-1).body.bends.length, 5);
  // arming
  await bar(page, /Arm…/).click();
  await page.getByText('This page is not an emergency stop').waitFor();
  await shot(page, 'operate-arming');
  await audit(page, 'arming');
  const arm = page.getByRole('button', {name: 'Hold 1 s to arm'}), box = await arm.boundingBox();
  await arm.click();  // not held for long enough
  assert.equal(calls('arm').length, 0);
  await page.mouse.move(box.x + 20, box.y + 20);
  await page.mouse.down();
  await arrived(stand, () => calls('arm').length === 1);
  await page.mouse.up();
  await bar(page, /MOVE/).waitFor();
  assert.ok(await page.locator('.arming-dialog').isHidden());
  await shot(page, 'operate-armed');
  // Move, by key, by pointer, by Enter
  const moves = async (press, release, what) => {
    const before = calls('move').length;
    await press();
    await arrived(stand, () => calls('move').length > before + 2);
    assert.ok(calls('move').slice(before).every(({body}) => body.held), what);
    await release();
    await arrived(stand, () => calls('move').at(-1).body.held === false);
    const count = calls('move').length;
    await pause(250);
    assert.ok(calls('move').slice(count).every(({body}) => !body.held), `${what}: nothing is held after it was released`);
  };
  await page.locator('#op-view').focus();
  await moves(() => page.keyboard.down('m'), () => page.keyboard.up('m'), 'key');
  const move = await bar(page, /MOVE/).boundingBox();
  await page.mouse.move(move.x + 30, move.y + 30);
  await moves(() => page.mouse.down(), () => page.mouse.up(), 'pointer');
  await bar(page, /MOVE/).focus();
  await moves(() => page.keyboard.down('Enter'), () => page.keyboard.up('Enter'), 'Enter');
  const holds = calls('hold').length;
  await page.keyboard.press(' ');  // on a button, too
  await arrived(stand, () => calls('hold').length === holds + 1);
  await page.locator('#op-view').focus();
  await moves(() => page.keyboard.down('m'), () => page.evaluate(() => window.dispatchEvent(new Event('blur'))), 'lost focus');
  await arrived(stand, () => calls('disarm').length === 1);
  await page.keyboard.up('m');
  await bar(page, /Arm…/).waitFor();
  // retract, which is refused once
  stand.push({...stand.frame, state: 'armed', armed_left: 60});
  stand.refusals.retract = {code: 'no_path', message: 'no way in was recorded: draw the stage back by Move'};
  await bar(page, /MOVE/).waitFor();
  await page.keyboard.down('r');
  await page.locator('#op-notice', {hasText: 'no way in was recorded'}).waitFor();
  await pause(250);
  assert.equal(calls('retract').filter(({body}) => body.held).length, 1, 'what is refused is not asked again');
  await page.keyboard.up('r');
  await page.keyboard.press('x');
  await arrived(stand, () => calls('disarm').length === 2);
  // speed
  await page.keyboard.press('+');
  await arrived(stand, () => calls('speed').length === 1);
  assert.equal(calls('speed')[0].body.tendon, 0.0025);
  // the lease is lost, and another page has it
  stand.takenElsewhere();
  await page.locator('#op-notice', {hasText: 'control is lost'}).waitFor();
  stand.push({...stand.frame, control: stand.control(), state: 'control'});
  await bar(page, /VIEW ONLY/).waitFor();
  assert.match(await bar(page, /VIEW ONLY/).innerText(), /another page controls since 10:41/);
  await shot(page, 'operate-taken');
  await done();
}

/** Over-tension locks all but Relax and Hold; not homed, there is Home; a wrong table is not armed. */
export async function operate_locked(browser, url) {
  const {stand, make, page, done} = await control(browser, url), {calls} = stand, [slack, options] = rows.over;
  await bar(page, /Take control/).click();
  await bar(page, /Arm…/).waitFor();
  stand.push({...await make(bends, slack, options), control: stand.control(), state: 'control'});
  await bar(page, /DISARMED by S4/).waitFor();
  for (const name of [/Straighten/, /Retract/, /Advance/, /DISARMED/]) assert.equal(await bar(page, name).getAttribute('aria-disabled'), 'true', String(name));
  await shot(page, 'operate-locked');
  await bar(page, /Straighten/).dispatchEvent('pointerdown', {button: 0, pointerId: 1});
  await page.locator('#op-notice', {hasText: 'locked: S4'}).waitFor();
  assert.equal(calls('straighten').length, 0);
  const relax = await bar(page, /Relax S4/).boundingBox();
  await page.mouse.move(relax.x + 20, relax.y + 20);
  await page.mouse.down();
  await pause(400);
  assert.equal(calls('relax').length, 0, 'not before a second');
  await arrived(stand, () => calls('relax').length > 2);
  await page.mouse.up();
  assert.equal(calls('relax')[0].body.section, 3);
  await page.keyboard.press('a');
  await arrived(stand, () => calls('acknowledge').length === 1);
  const empty = {word: 'SLACK', changes: [0, 0, 0], set: [0, 0, 0], target: [0, 0], measured: [0, 0], tension: [0, 0, 0], advice: 'Hold Home: its zeros are not set'};
  stand.push({...stand.frame, homed: false, alarm: alarm(0, 'SLACK', empty.advice, 4), sections: bends.map(() => empty)});
  await until(page, () => window.__sinew.operate.frame.homed === false);
  await bar(page, /Arm…/).click();
  const home = page.locator('.arming-dialog .home'), box = await home.boundingBox();
  await page.mouse.move(box.x + 20, box.y + 20);
  await page.mouse.down();
  await arrived(stand, () => calls('home').length > 1);
  stand.push({...stand.frame, activity: 'homing', homing: {section: 1, tendon: 2, step: 'take in', done: 5, of: 15}});
  await page.locator('.arming-dialog', {hasText: 'S2 tendon 3: take in, 5 of 15 done'}).waitFor();
  await shot(page, 'operate-homing');
  await page.mouse.up();
  await arrived(stand, () => calls('home').at(-1).body.held === false);
  stand.push({...stand.frame, link: 'wrong_table', message: "the firmware has another robot's table", homed: true});
  await page.locator('.arming-dialog', {hasText: "another robot's table"}).waitFor();
  assert.ok(await page.getByRole('button', {name: 'Hold 1 s to arm'}).isDisabled());
  await page.keyboard.press('Escape');
  await arrived(stand, () => calls('hold').length > 0);
  await page.locator('.arming-dialog').waitFor({state: 'hidden'});
  await done();
}

/** A server that is gone makes no quiet picture: the last one fades and says so, and what is held is let go. */
export async function operate_gone(browser, url) {
  const {stand, page, done} = await control(browser, url, {isOwn: true}), {calls} = stand;
  await bar(page, /Take control/).click();
  await arrived(stand, () => calls('lease').length > 1);
  stand.push({...stand.frame, state: 'armed', armed_left: 60});
  await bar(page, /MOVE/).waitFor();
  await page.locator('#op-view').focus();
  await page.keyboard.down('m');
  await arrived(stand, () => calls('move').length > 2);
  stand.close();
  await page.locator('#op-banner', {hasText: /NO DATA, \d+ s[^]*the picture is the last one/}).waitFor();
  await page.locator('#lost', {hasText: /NO CONNECTION \d+ s/}).waitFor();
  await page.locator('#op-notice', {hasText: 'no connection'}).waitFor();
  await until(page, () => window.__sinew.operate.subject.control.held === null);
  await bar(page, /VIEW ONLY.*no connection/s).waitFor();
  await page.locator('#op-bar.lost').waitFor();
  await looks(page, 'operate-gone');
  // it is back while the key is still down: the picture is live again, and nothing moves
  const back = await standIn(url, 'nottingham-tpcj', textOf('nottingham-tpcj'), {}, Number(new URL(stand.url).port));
  back.push({...stand.frame, control: back.control(), state: 'view_only', armed_left: 0});
  const telling = setInterval(() => back.push(back.frame), 50);
  await page.locator('#lost').waitFor({state: 'hidden'});
  await page.locator('#op-banner', {hasText: 'ALL SECTIONS EXACT'}).waitFor();
  await bar(page, /Take control/).waitFor();
  await pause(300);
  assert.deepEqual(back.said.filter(({body}) => body.held), []);
  await page.keyboard.up('m');
  clearInterval(telling);
  await done();
  back.close();
}

/** A gamepad at a device: its shoulder moves while it is down; what is let go, or pulled out, moves nothing; its second button holds. */
export async function operate_gamepad(browser, url) {
  const {stand, page, done} = await control(browser, url, {locale: 'en'}), {calls} = stand;
  await page.addInitScript(() => {
    window.__pad = {connected: true, axes: [0, 0, 0, 0], buttons: Array.from({length: 16}, () => ({pressed: false}))};
    navigator.getGamepads = () => [window.__pad];
  });
  await page.reload();
  await operated(page, 0);
  const press = (button, is) => page.evaluate(([one, down]) => { window.__pad.buttons[one].pressed = down; }, [button, is]);
  await press(5, true);
  await page.locator('#op-notice', {hasText: 'take control first'}).waitFor();
  await press(5, false);
  await bar(page, /Take control/).click();
  await arrived(stand, () => calls('lease').length > 1);
  await press(5, true);
  await page.locator('#op-notice', {hasText: 'arm first'}).waitFor();
  await press(5, false);
  assert.equal(calls('move').length, 0);
  stand.push({...stand.frame, state: 'armed', armed_left: 60});
  await bar(page, /MOVE/).waitFor();
  const isLetGo = async (call) => {
    await arrived(stand, () => calls(call).at(-1).body.held === false);
    const count = calls(call).length;
    await pause(250);
    assert.ok(calls(call).slice(count).every(({body}) => !body.held), call);
  };
  for (const [button, call] of [[5, 'move'], [12, 'advance'], [13, 'retract']]) {
    await press(button, true);
    await arrived(stand, () => calls(call).filter(({body}) => body.held).length > 2);
    await press(button, false);
    await isLetGo(call);
  }
  const before = calls('move').length;
  await press(5, true);
  await arrived(stand, () => calls('move').length > before + 2);
  await page.evaluate(() => { window.__pad.connected = false; });
  await isLetGo('move');
  await page.evaluate(() => {
    window.__pad.connected = true;
    window.__pad.buttons[5].pressed = false;
    window.dispatchEvent(new Event('gamepadconnected'));
  });
  const holds = calls('hold').length;
  await press(1, true);
  await arrived(stand, () => calls('hold').length === holds + 1);
  await page.keyboard.press('j');
  const title = (ending) => page.locator('#op-jog h2', {hasText: new RegExp(`· ${ending}$`)}).waitFor();
  await title('gamepad');
  await page.evaluate(() => {
    window.__pad.connected = false;
    window.dispatchEvent(new Event('gamepaddisconnected'));
  });
  await title('no gamepad');
  await fits(page);
  await done();
}

/** A phone looks on and holds, whatever it is asked for. */
export async function operate_phone(browser, url) {
  const {stand, page, done} = await control(browser, url, {width: 390, height: 844}), {said, calls} = stand;
  assert.equal(await page.locator('#source').innerText(), 'VIEW ONLY');
  assert.deepEqual(await page.locator('#op-bar button:visible').allInnerTexts(), ['HOLD Space'].map((text) => text.replace(' Space', '')));
  await page.evaluate(() => document.querySelectorAll('#op-bar button:not(.hold), .drawer button').forEach((one) => {
    for (const type of ['pointerdown', 'click']) one.dispatchEvent(new PointerEvent(type, {bubbles: true, pointerId: 1}));
  }));
  for (const key of ['m', 'r', 'w', 'x', '+']) {
    await page.keyboard.down(key);
    await pause(30);
    await page.keyboard.up(key);
  }
  await page.locator('.plot-of').first().click();
  await pause(150);
  assert.deepEqual(said.filter(({call}) => call !== 'hold'), [], 'a phone asks for nothing but Hold');
  await page.locator('.hold').click();
  await arrived(stand, () => calls('hold').length > 0);
  for (const target of await page.locator('.hold, .chips button').all()) assert.ok((await target.boundingBox()).height >= 60);
  await fits(page);
  await done();
}

/** A camera and a gamepad, where there are some. */
export async function operate_aids(browser, url) {
  const {page, done} = await blank(browser, {locale: 'en'});
  await page.addInitScript(() => {
    window.__pad = {connected: true, axes: [0, 0, 0, 0], buttons: Array.from({length: 16}, () => ({pressed: false}))};
    navigator.getGamepads = () => [window.__pad];
    navigator.mediaDevices.enumerateDevices = () => Promise.resolve([{kind: 'videoinput'}]);
    navigator.mediaDevices.getUserMedia = () => {
      const canvas = Object.assign(document.createElement('canvas'), {width: 320, height: 240}), context = canvas.getContext('2d');
      setInterval(() => {
        context.fillStyle = '#446';
        context.fillRect(0, 0, 320, 240);
      }, 50);
      return Promise.resolve(canvas.captureStream());
    };
  });
  await page.goto(`${url}#robot=nottingham-tpcj&screen=operate`);
  await operated(page, 0);
  const give = await page.evaluateHandle(() => navigator.mediaDevices.getUserMedia);
  for (const [name, why] of [['NotAllowedError', 'the browser was not allowed to use a camera'], ['NotReadableError', 'no picture comes from the camera']]) {
    await page.evaluate((of) => { navigator.mediaDevices.getUserMedia = () => Promise.reject(new DOMException('', of)); }, name);
    await page.getByRole('button', {name: 'Show the camera'}).click();
    await page.locator('.eye-note', {hasText: why}).waitFor();
  }
  await shot(page, 'operate-no-camera');
  await page.evaluate((of) => { navigator.mediaDevices.getUserMedia = of; }, give);
  await page.getByRole('button', {name: 'Show the camera'}).click();
  const saved = page.waitForEvent('download');
  await page.getByRole('button', {name: /Snapshot/}).click();
  const bytes = readFileSync(await (await saved).path()).toString('latin1');
  assert.match(bytes, /set-points \[rad\]: \[\[0,0\]/);
  await page.evaluate(() => { window.__pad.buttons[15].pressed = true; });
  await until(page, () => document.querySelector('.section.chosen .name').textContent === 'S2');
  await page.evaluate(() => { window.__pad.axes = [1, 0, 0, -1]; });
  await until(page, () => window.__sinew.operate.frame.sections[1].point[0] > 0.01 && window.__sinew.operate.frame.sections[4].point[1] > 0.01);
  await page.evaluate(() => { window.__pad.axes = [0, 0, 0, 0]; });
  await shot(page, 'operate-camera');
  await audit(page, 'camera');
  await done();
}

/** By WebGL: the arm moves in the picture. */
export async function operate_pictures(browser, url) {
  for (const [width, height] of sizes) {
    const {page, done} = await see(browser, url, 'nottingham-tpcj', '&inputs=0.1,-0.05,-0.1,0.1,0.05,0.1,0.1,0.2,0.1,0.05&slack=0,0,0.0003,-0.0004,0', {width, height, theme: width < 720 ? 'dark' : 'light'});
    const view = () => page.locator('#op-view').screenshot();
    await until(page, () => document.querySelector('#op-view canvas') !== null);
    await pause(200);
    const before = await view();
    await shot(page, `operate-webgl-${width}`);
    if (width > 720) {
      await page.keyboard.press('1');
      await answered(page, () => page.keyboard.press('Shift+ArrowRight'));
      differs(await view(), before, 'a target');
      await answered(page, () => page.keyboard.press('Shift+ArrowLeft'));
      same(await view(), before, 'and back');
    }
    await done();
  }
}
