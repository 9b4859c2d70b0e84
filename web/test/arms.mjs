// Elastic arms on the Design screen: tendons that are pulled or paid out, loads, and what is told of them.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {audit, blank, differs, fill, hold, linked, looks, numbers, open, picture, rested, same, settled, shot, sinew, tab, then, verdict} from './harness.mjs';

const said = (page) => page.evaluate(() => window.__sinew.answer());
const command = (page) => page.locator('#command').innerText();
const legend = (page) => page.locator('#view .pulls').innerText();
const values = (page) => page.locator('#inputs .row input:not([type=range])').evaluateAll((all) => all.map((box) => box.value));
/** What is held otherwise is solved anew, to the resolution of the solver: of a tendon that does not stretch a nanometre is a millinewton. */
const near = (a, b, by, what) => assert.ok(a.every((value, i) => Math.abs(value - b[i]) <= by), `${what}: ${a} and ${b}`);

/** Numbers of the tip alone. */
const tip = async (page) => (await numbers(page)).split('Margins')[0];

/** One question a move of a slider; tensions, curvature, margins and what was solved, with units; colours have a scale, which the layer takes away. */
export async function arm_answers(browser, url) {
  const {page, done} = await open(browser, url, 'two-segment');
  assert.match(await legend(page), /^Tension\s+0\s+1 N\s+slack$/);
  assert.match(await numbers(page), /slack\s+6 of 6 tendons/);
  const held = await hold(page);
  await page.locator('#inputs-0').fill('4');
  await page.locator('#inputs-0').press('Enter');
  await held.arrival(1);
  const asked = held.asked.map((text) => JSON.parse(text));
  assert.deepEqual(asked.map((all) => all.map(({query}) => query)), [['forward']]);
  assert.deepEqual(asked[0][0].tensions, [[4, 0, 0], [0, 0, 0]]);
  await then(page, () => held.release());
  await rested(page);
  await page.unrouteAll({behavior: 'ignoreErrors'});
  assert.equal(await verdict(page), 'SOLVED, STABLE');
  assert.match(await page.locator('#verdict .detail').innerText(), /^residual [\d.e-]+ EI\/L · resolution [\d.e-]+ mm · \d+ iterations$/);
  await then(page, () => fill(page, 'inputs-4', '2'));
  await rested(page);
  const all = await numbers(page), answer = await said(page);
  assert.match(all, /slack\s+4 of 6 tendons\s+to buckling\s+0\.\d+/);
  assert.match(all, /Tensions \[N\]\s+S1 1\s+4\.000\s+S1 2\s+slack\s+S1 3\s+slack\s+S2 1\s+slack\s+S2 2\s+2\.000\s+S2 3\s+slack/);
  assert.match(all, /Tendon changes \[mm\]\s+S1 1\s+-\d/);
  assert.match(all, /Compliance of the tip \[mm\/N\]\s+x\s+\d/);
  assert.match(all, /Curvature along the arm \[1\/m\]/);
  const bends = answer.curvatures.map(([x, y]) => Math.hypot(x, y)), words = await page.locator('.profile svg').getAttribute('aria-label');
  assert.equal(words, `curvature from ${Math.min(...bends).toFixed(3)} to ${Math.max(...bends).toFixed(3)} 1/m along the backbone`);
  assert.match(await legend(page), /^Tension\s+0\s+4 N\s+slack$/);
  assert.equal(await command(page), 'sinew forward two-segment --tensions "4, 0, 0; 0, 2, 0"');
  await looks(page, 'arm-tensions');
  const before = await picture(page);
  await page.locator('#layers summary').click();
  await page.locator('[data-layer="tendons"]').uncheck();
  await page.locator('#view .pulls').waitFor({state: 'hidden'});  // a scale of what is not drawn
  await page.locator('[data-layer="tendons"]').check();
  await page.locator('#layers summary').click();
  await page.evaluate(() => document.activeElement.blur());
  same(await picture(page), before, 'the picture with its tendons again');
  assert.match(await page.locator('#strip .choices').innerText(), /buckling margin\s+least tension\s+S1 Δ₁/);
  await page.locator('#units').click();
  assert.match(await numbers(page), /Compliance of the tip \[m\/N\]/);
  assert.match(await page.locator('#verdict .detail').innerText(), /resolution/);
  await done();
}

/** What holds a tendon is changed, one by one or all: the arm stays where it is. Undo, links and the ghost follow. */
export async function arm_holds(browser, url) {
  const {page, done} = await open(browser, url, 'two-segment');
  await then(page, () => fill(page, 'inputs-0', '3'));
  await then(page, () => fill(page, 'inputs-4', '1'));
  const [where, pulled] = [(await said(page)).tip.position, await values(page)], stays = async () => near((await said(page)).tip.position, where, 1e-5, 'it moved as its tendons were held otherwise');
  await then(page, () => page.getByRole('button', {name: 'Length changes'}).click());
  await stays();
  assert.equal(await page.locator('#inputs label').first().innerText(), 'S1 Δ₁');
  assert.equal(await page.locator('#inputs .unit').first().innerText(), 'mm');
  assert.match(await command(page), /^sinew forward two-segment --changes "-0\.00[\d., ;-]+"$/);
  near((await said(page)).tensions.flat(), [3, 0, 0, 0, 1, 0], 0.01, 'tensions of the lengths that they gave');
  await then(page, () => fill(page, 'inputs-1', '12'));
  assert.match(await numbers(page), /slack\s+\d of 6 tendons\s+slack by at most\s+\d+\.\d+ mm/);
  await rested(page);
  await looks(page, 'arm-changes');
  await then(page, () => page.locator('#inputs .unit').first().click());
  await stays();
  assert.match(await command(page), /--tensions "(3|2\.99\d*|3\.00\d*), null, null; null, null, null" --changes "null, 0\.012, /);
  await rested(page);
  const link = await linked(page), shown = await numbers(page);
  assert.match(link, /held=tccccc/);
  const second = await blank(browser);
  await second.page.goto(link);
  await settled(second.page, 0);
  await rested(second.page);
  assert.equal(await numbers(second.page), shown, 'a link shows what it was copied from');
  await second.done();
  for (let i = 0; i < 3; ++i) await then(page, () => page.locator('#undo').click());
  assert.equal(await page.locator('#inputs .unit').first().innerText(), 'N');
  assert.deepEqual(await values(page), pulled);
  await page.locator('#keep').click();
  await then(page, () => page.getByRole('button', {name: 'Length changes'}).click());
  assert.match(await numbers(page), /from the ghost/);
  await page.locator('#against').selectOption('ftdcr-v4');
  await page.locator('#numbers', {hasText: 'from the ghost, ftdcr-v4 at home'}).waitFor();
  await done();
}

/** The command gives, in a shell, where the tip is. */
export async function arm_commands(browser, url) {
  const {page, done} = await blank(browser);
  for (const hash of ['robot=two-segment&inputs=4,0,0,0,2,0', 'robot=ftdcr-v4&held=ccccccccc&inputs=-0.001,0,0.001,0,0,0,0,0,0', 'robot=tendon-rod&held=tcct&inputs=3,0.01,0.01,1&load=0.5,0,-1,0,0,0.05,0.25,0,0.4,0',
                      'robot=ftdcr-v4&model=prb&joints=2&gravity=off', 'robot=two-segment&asked=pose&pose=0.05,0.1,0.36', 'robot=tendon-rod&asked=pose&pose=0.4,1&model=cc']) {
    await then(page, () => page.goto(`${url}#${hash}`));
    assert.match(await verdict(page), /SOLVED/, hash);
    await page.locator('#copy').click();
    const text = await page.evaluate(() => navigator.clipboard.readText()), mine = (await said(page)).tip.position;
    const printed = JSON.parse(execFileSync('/bin/sh', ['-c', `${text.replace(/^sinew/, `'${sinew}'`)} --json`], {encoding: 'utf8'})).tip.position;
    for (const [i, value] of printed.entries()) assert.ok(Math.abs(value - mine[i]) < 1e-8, `${text}\n${printed}\n${mine}`);
  }
  await done();
}

/** Loads are arrows with their values: at the tip, and where a second force is. */
export async function arm_loads(browser, url) {
  const {page, done} = await open(browser, url, 'ftdcr-v4'), arrows = () => page.locator('#view .label.load:visible').allInnerTexts();
  await tab(page, 'Load');
  assert.deepEqual(await arrows(), []);
  const [before, where] = [await picture(page), await tip(page)];
  await then(page, () => fill(page, 'load-0', '0.2'));
  assert.deepEqual(await arrows(), ['0.2 N']);
  await then(page, () => fill(page, 'load-4', '5 N mm'));
  await then(page, () => fill(page, 'load-6', '80'));
  await then(page, () => fill(page, 'load-9', '-0.3'));
  assert.deepEqual((await arrows()).sort(), ['0.005 N m', '0.2 N', '0.3 N']);
  assert.equal(await command(page), `sinew forward ftdcr-v4 --tensions "2, 2, 2; 2, 2, 2; 2, 2, 2" --wrench "0.2, 0, 0, 0, 0.005, 0" --loads '[{"place":0.08,"wrench":[0,0,-0.3,0,0,0]}]'`);
  assert.notEqual(await tip(page), where);
  await rested(page);
  await looks(page, 'arm-loads');
  await then(page, () => page.getByRole('button', {name: 'Zero'}).click());
  assert.equal(await page.locator('#load-6').inputValue(), '93.250');
  assert.deepEqual(await arrows(), []);
  assert.equal(await tip(page), where);
  await page.evaluate(() => document.activeElement.blur());
  same(await picture(page), before, 'the picture without its loads');
  await then(page, () => page.getByLabel('Gravity as in the file').click());
  assert.match(await tip(page), /y\s+0\.000 mm/);
  await then(page, () => fill(page, 'load-6', '500'));
  await then(page, () => fill(page, 'load-7', '0.1'));
  assert.equal(await verdict(page), 'REFUSED');
  assert.match(await page.locator('#verdict .reason').innerText(), /loads\[0\]\.place = 0\.5; it must be more than 0 mm and at most 186\.5 mm/);
  await done(/422|400/);
}

/** Other equilibria are small pictures to go to: a link and the command lead there as well; how much more load the arm bears is a bar. */
export async function arm_solutions(browser, url) {
  const {page, done} = await blank(browser), cards = page.locator('#solutions .small'), title = page.locator('#solutions h3');
  const tipNow = async () => (await said(page)).tip.position;
  await then(page, () => page.goto(`${url}#robot=tendon-rod&held=cccc&inputs=0.01,0.01,0.01,0.01&load=0,0,-60,0,0,0,0.25,0,0,0`));
  await title.filter({hasText: 'Solutions (at least'}).waitFor();
  assert.match(await title.innerText(), /^Solutions \(at least [5-9]\)$/);
  assert.equal(await page.locator('#solutions .small[aria-current=true]').count(), 1);
  assert.equal(await cards.count(), await page.locator('#solutions .small svg path.sk-body, #solutions .small svg path.sk-rod').count());
  assert.match(await numbers(page), /(more load|load to [a-z_]+)\s+(> )?[\d.]+ ×/);
  await rested(page);
  await looks(page, 'arm-solutions');
  assert.doesNotMatch(await command(page), /--start/);
  const before = await tipNow(), other = cards.locator('visible=true').filter({hasNotText: 'shown'}).last();
  await then(page, () => other.click());
  await rested(page);
  const there = await tipNow();
  assert.ok(Math.hypot(...there.map((part, i) => part - before[i])) > 0.01, 'it stayed where it was');
  assert.equal(await verdict(page), 'SOLVED, STABLE');
  assert.match(await command(page), /--start "(-?[\d.]+, -?[\d.]+, -?[\d.]+(; )?)+"/);
  const words = (await command(page)).replace(/^sinew/, `'${sinew}'`);
  near(JSON.parse(execFileSync('/bin/sh', ['-c', `${words} --json`], {encoding: 'utf8'})).tip.position, there, 1e-6, words);
  const second = await blank(browser);
  await second.page.goto(await linked(page));
  await settled(second.page, 0);
  await rested(second.page);
  near((await said(second.page)).tip.position, there, 1e-6, 'a link leads elsewhere');
  await second.done();
  await then(page, () => fill(page, 'inputs-0', '10.1'));  // goes on from there
  near(await tipNow(), there, 0.02, 'it left its branch');
  await then(page, () => page.locator('#undo').click());
  await then(page, () => page.locator('#undo').click());
  near(await tipNow(), before, 1e-6, 'undo leads back');
  await then(page, () => page.goto(`${url}#robot=two-segment&inputs=0,0,0,0,0,0&load=0,0,-8,0,0,0,0.2,0,0,0`));
  await title.filter({hasText: 'Other solutions: beside it, to which it may move freely'}).waitFor();
  await done();
}

/** Where the tip was seen tells the force at it: that force as a load takes the tip there. */
export async function arm_senses(browser, url) {
  const {page, done} = await open(browser, url, 'two-segment');
  await then(page, () => fill(page, 'inputs-0', '3'));
  await tab(page, 'Load');
  await then(page, () => fill(page, 'load-0', '0.03'));
  await then(page, () => fill(page, 'load-1', '-0.02'));
  const seen = (await said(page)).tip.position.map((part) => (1000 * part).toFixed(6)).join(', ');
  await then(page, () => page.getByRole('button', {name: 'Zero'}).click());
  const straight = await tip(page);
  await then(page, () => fill(page, 'sensed', seen));
  const values = await Promise.all([0, 1, 2].map((i) => page.locator(`#load-${i}`).inputValue()));
  assert.deepEqual(values, ['0.030', '-0.020', '0.000']);
  assert.match(await page.locator('#toast').innerText(), /^0\.0361 N at the tip, ± [\d.]+ N where it is seen to 0\.500 mm$/);
  assert.notEqual(await tip(page), straight);
  for (const [text, why] of [['1, 2', /^give three numbers, x, y, z; found 2$/], ['1 N, 2, 3', /^N is no unit of length$/], ['0, 0, 300', /^no force at the tip explains it: /]]) {
    await fill(page, 'sensed', text);
    await page.locator('.sense .why', {hasText: why}).waitFor();
  }
  assert.equal(await page.locator('#load-0').inputValue(), '0.030', 'a load that was not sensed');
  await done();
}

/** The tip is placed where there are sections enough, else it is turned; what cannot be reached says so, and goes back. */
export async function arm_poses(browser, url) {
  const {page, done} = await open(browser, url, 'two-segment');
  await then(page, () => fill(page, 'inputs-0', '2'));
  await tab(page, 'Pose');
  await then(page, () => fill(page, 'pose-2', '350 mm'));
  await then(page, () => fill(page, 'pose-0', '40 mm'));
  assert.match(await verdict(page), /SOLVED/);
  assert.match(await page.locator('#verdict .detail').innerText(), /^residual [\d.e-]+ of the length, or rad/);
  assert.match(await tip(page), /x\s+(40\.000|39\.999) mm/);
  assert.match(await command(page), /^sinew inverse two-segment --position "0\.04, /);
  await then(page, () => page.locator('#robot').selectOption('tendon-rod'));
  await then(page, () => fill(page, 'pose-0', '30 deg'));
  assert.match(await tip(page), /tilt\s+30\.00°/);
  assert.match(await command(page), /^sinew inverse tendon-rod --direction "0\.5, 0, 0\.866/);
  await rested(page);
  const box = await page.locator('#view').boundingBox(), [x, y] = await page.evaluate(() => window.__sinew.scene.lookout.project(window.__sinew.answer().tip.position));
  await page.mouse.move(box.x + x, box.y + y);
  assert.equal(await page.locator('#view').evaluate((view) => view.style.cursor), '', 'a hand that cannot drag it');
  await done();
}

/** What an arm cannot do is said in a sentence: tendons do not push, nor stretch enough; the other screens show other robots. */
export async function arm_refusals(browser, url) {
  const {page, done} = await open(browser, url, 'two-segment'), before = await picture(page);
  await then(page, () => fill(page, 'inputs-0', '-1'));
  assert.equal(await verdict(page), 'REFUSED');
  assert.match(await page.locator('#verdict .reason').innerText(), /tensions\[0\]\[0\] = -1; it must not be negative/);
  await then(page, () => page.locator('#verdict').getByRole('button', {name: 'Back to the last solved pose'}).click());
  assert.equal(await verdict(page), 'SOLVED, STABLE');
  await page.evaluate(() => document.activeElement.blur());
  same(await picture(page), before);
  await then(page, () => page.getByRole('button', {name: 'Length changes'}).click());
  await then(page, () => fill(page, 'inputs-0', '-150'));
  assert.equal(await verdict(page), 'STALLED');
  assert.match(await page.locator('#verdict .reason').innerText(), /no equilibrium was found/);
  assert.match(await page.locator('#verdict .advice').innerText(), /pay out the tendons on the other side/);
  assert.ok(await page.locator('#answer').evaluate((answer) => answer.classList.contains('stale')), 'numbers of another pose');
  differs(await picture(page), before, 'the picture, which fades');
  await rested(page);
  await shot(page, 'arm-stalled');
  await then(page, () => page.locator('#verdict').getByRole('button', {name: 'Back to the last solved pose'}).click());
  await tab(page, 'Model');
  assert.match(await page.locator('#model .note').innerText(), /^Operate and Trajectory show serial robots/);
  assert.ok(await page.locator('#screens').isHidden(), 'buttons of screens that show no arm');
  await page.locator('#solutions h3', {hasText: /^Other solutions: none found$/}).waitFor();
  await page.goto(`${url}#robot=tendon-rod&screen=operate`);
  await page.locator('#toast', {hasText: 'Operate shows serial robots'}).waitFor();
  assert.equal(await page.evaluate(() => document.body.dataset.screen), 'design');
  await rested(page);
  for (const name of ['Inputs', 'Pose', 'Load', 'Model', 'File']) {
    await tab(page, name);
    await audit(page, `arm ${name}`);
  }
  await done(/422|400/);
}

/** Tendons that rub: every move is followed as a path, which the command gives in a shell; there and back is a loop, and undo goes back along it. */
export async function arm_friction(browser, url) {
  const {page, done} = await open(browser, url, 'two-segment'), folder = mkdtempSync(join(tmpdir(), 'sinew-rubs-'));
  assert.ok(await page.locator('.remembers').isHidden(), 'tendons that do not rub have nothing to remember');
  const rubbing = (await page.evaluate(() => window.__sinew.file.text)).replace('angle: 90 deg}', 'angle: 90 deg, friction: 0.3}');
  writeFileSync(join(folder, 'rubbing.yaml'), rubbing);
  await then(page, () => page.evaluate((of) => {
    const data = new DataTransfer();
    data.items.add(new File([of], 'rubbing.yaml'));
    window.dispatchEvent(new DragEvent('drop', {dataTransfer: data, cancelable: true}));
  }, rubbing));
  assert.match(await verdict(page), /SOLVED/);
  const rubs = page.getByLabel('Friction remembered');
  await then(page, () => rubs.click());
  const at = async (tension) => {
    await then(page, () => fill(page, 'inputs-0', tension));
    return said(page);
  };
  const there = await at('1.5'), most = await at('4'), back = await at('1.5');
  assert.equal(back.query, 'track');
  assert.equal(there.status, 'converged');
  assert.ok(Math.hypot(...back.tip.position.map((part, i) => part - there.tip.position[i])) > 5e-3, 'it came back to where it was');
  assert.ok(most.tensions_along[0].at(-1) < 3.5 && back.tensions_along[0].at(-1) > 1.5, 'friction holds against the way it goes');
  const text = await numbers(page), words = await page.locator('.loop svg').getAttribute('aria-label');
  assert.match(text, /Tip from straight \[mm\] over S1 T₁, along the path/);
  assert.match(words, /^the tip is [\d.]+ mm from straight at S1 T₁ = 1\.500 N, after 3 moves$/);
  await rested(page);
  await looks(page, 'arm-friction');
  const line = await command(page);
  assert.match(line, /^echo '\{"query":"track","points":\[.*\| sinew query rubbing\.yaml$/);
  const printed = JSON.parse(execFileSync('/bin/sh', ['-c', line.replace('| sinew', `| '${sinew}'`)], {encoding: 'utf8', cwd: folder}));
  near(printed.tip.position, back.tip.position, 1e-12, 'the command of the path');
  await page.waitForTimeout(800);  // what follows without a pause is one step of undo
  await at('1');  // straight on: no turn more
  assert.match(await page.locator('.loop svg').getAttribute('aria-label'), /after 3 moves$/);
  await then(page, () => page.locator('#undo').click());
  near((await said(page)).tip.position, back.tip.position, 1e-9, 'undone along the path');
  await then(page, () => page.getByRole('button', {name: 'Forget the path'}).click());
  assert.match(await page.locator('.loop svg').getAttribute('aria-label'), /after 1 move$/);
  await then(page, () => rubs.click());
  assert.equal((await said(page)).query, 'forward');
  assert.equal(await page.locator('.loop').count(), 0);
  rmSync(folder, {recursive: true});
  await audit(page, 'an arm that remembers');
  await done();
}

/** A platform on arms: tendons by leg and section, the platform's pose either way, its load; the command does the same. */
export async function arm_legs(browser, url) {
  const {page, done} = await open(browser, url, 'tripod-two-section');
  const place = async () => (await said(page)).pose.position;
  assert.equal(await verdict(page), 'SOLVED, STABLE');
  assert.equal(await page.locator('#inputs label').first().innerText(), 'L1 S1 T₁');
  assert.equal(await page.locator('#inputs .row').count(), 18);
  assert.match(await numbers(page), /Pose of the platform\s+x/);
  const before = await place(), seen = await picture(page);
  await then(page, () => fill(page, 'inputs-0', '1'));
  assert.ok(Math.hypot(...(await place()).map((part, i) => part - before[i])) > 1e-4, 'a tendon that moves nothing');
  differs(await picture(page), seen, 'the picture');
  assert.match(await numbers(page), /Tensions \[N\]\s+L1 S1 1\s+1\.000/);
  assert.match(await numbers(page), /Compliance of the platform/);
  const printed = JSON.parse(execFileSync('/bin/sh', ['-c', `${(await command(page)).replace(/^sinew/, `'${sinew}'`)} --json`], {encoding: 'utf8'}));
  near(printed.pose.position, await place(), 1e-9, 'the command');
  await tab(page, 'Load');
  await then(page, () => fill(page, 'load-0', '0.1'));
  assert.deepEqual(await page.locator('#view .label.load:visible').allInnerTexts(), ['0.1 N']);
  await rested(page);
  assert.match(await numbers(page), /(more load|load to [a-z_]+)\s+(> )?[\d.]+ ×/);
  await looks(page, 'arm-legs');
  await tab(page, 'Inputs');
  await then(page, () => page.getByRole('button', {name: 'Length changes'}).click());
  assert.equal(await page.locator('#inputs label').first().innerText(), 'L1 S1 Δ₁');
  await then(page, () => page.getByRole('button', {name: 'Tensions'}).click());
  await tab(page, 'Load');
  await then(page, () => page.getByRole('button', {name: 'Zero'}).click());
  await tab(page, 'Inputs');
  await then(page, () => page.locator('#inputs').getByRole('button', {name: 'Home'}).click());
  await tab(page, 'Pose');
  await then(page, () => fill(page, 'pose-2', '198 mm'));
  await then(page, () => fill(page, 'pose-0', '3 mm'));
  assert.match(await verdict(page), /^SOLVED/);
  near([(await place())[0]], [0.003], 1e-6, 'where it was put');
  assert.match(await command(page), /^sinew inverse \S+ --pose "0\.003, /);
  await done();
}

/** The command's answer. */
const printed = async (page) => JSON.parse(execFileSync('/bin/sh', ['-c', (await command(page)).replace(/(^|\| )sinew/, `$1'${sinew}'`) + ((await command(page)).startsWith('echo') ? '' : ' --json')], {encoding: 'utf8'}));

/** Legs of a platform on arms bear forces of their own, one at a place and one along all: arrows, links and the command have them. */
export async function arm_legs_loads(browser, url) {
  const {page, done} = await open(browser, url, 'tripod-two-section'), arrows = async () => (await page.locator('#view .label.load:visible').allInnerTexts()).sort();
  const place = async () => (await said(page)).pose.position;
  await tab(page, 'Load');
  assert.equal(await page.locator('#load .row').count(), 14);
  assert.equal(await page.locator('#load h2').first().innerText(), 'Load on platform and legs');
  assert.equal(await page.locator('#load-6').inputValue(), '1');
  const [before, seen] = [await place(), await picture(page)];
  await then(page, () => fill(page, 'load-8', '0.05'));
  const first = await place();
  await then(page, () => fill(page, 'load-6', '2'));
  assert.ok(Math.hypot(...(await place()).map((part, i) => part - first[i])) > 1e-5, 'on which leg it acts does not matter');
  await then(page, () => fill(page, 'load-7', '60'));
  assert.deepEqual(await arrows(), ['0.05 N']);
  assert.match(await command(page), / --loads '\[{"leg":1,"place":0\.06,"wrench":\[0\.05,0,0,0,0,0\]}\]'$/);
  near((await printed(page)).pose.position, await place(), 1e-9, 'the command');
  await then(page, () => fill(page, 'load-13', '-0.5'));
  assert.equal((await arrows()).length, 4);
  assert.match(await command(page), / --distributed "0, 0, -0\.5" --loads /);
  near((await printed(page)).pose.position, await place(), 1e-9, 'the command');
  await then(page, () => page.locator('#load input[type=range]').nth(6).press('ArrowRight'));  // a leg on, not a hundredth of one
  assert.equal(await page.locator('#load-6').inputValue(), '3');
  await rested(page);
  await looks(page, 'arm-legs-loads');
  const second = await blank(browser);
  await second.page.goto(await linked(page));
  await settled(second.page, 0);
  near((await said(second.page)).pose.position, await place(), 1e-6, 'a link leads elsewhere');
  await second.done();
  await then(page, () => fill(page, 'load-6', '7'));
  assert.equal(await verdict(page), 'REFUSED');
  assert.match(await page.locator('#verdict .reason').innerText(), /loads\[0\]\.leg/);
  await then(page, () => page.getByRole('button', {name: 'Zero'}).click());
  near(await place(), before, 1e-9, 'without its loads');
  await page.evaluate(() => document.activeElement.blur());
  same(await picture(page), seen, 'the picture without its loads');
  await then(page, () => page.goto(`${url}#robot=3-rfr-two-section&load=0,0,0,2,0.08,0.1,0,0,0.5`));
  assert.match(await command(page), / --distributed "0, 0\.5, 0" --loads '\[{"leg":1,"place":0\.08,"wrench":\[0\.1,0,0\]}\]'$/);
  assert.match(await verdict(page), /^SOLVED/);
  await looks(page, 'arm-legs-loads-plane');
  await done(/422|400/);
}

/** Other equilibria of a platform on arms are small pictures to go to, and are followed from there. */
export async function arm_legs_solutions(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr-two-section'), cards = page.locator('#solutions .small'), title = page.locator('#solutions h3');
  const here = async () => { const {x, y, phi} = (await said(page)).pose; return [x, y, phi]; };
  const look = async () => {
    await rested(page);
    const search = page.getByRole('button', {name: 'Look for others'});
    if (await search.isVisible()) await search.click();
    await title.filter({hasText: 'Solutions (at least'}).waitFor();
  };
  await look();
  assert.equal(await page.locator('#solutions .small[aria-current=true]').count(), 1);
  assert.match(await numbers(page), /Compliance of the platform \[mm\/N\]\s+x\s+[\d.]+\s+y\s+[\d.]+(?!\s+z)/);
  await cards.last().scrollIntoViewIfNeeded();
  await looks(page, 'arm-legs-solutions');
  assert.doesNotMatch(await command(page), /start/);
  const before = await here();
  await then(page, () => cards.filter({hasNotText: 'shown'}).first().click());
  await look();
  const there = await here();
  assert.ok(Math.abs(there[2] - before[2]) > 0.1, 'it stayed where it was');
  assert.match(await verdict(page), /^SOLVED, STABLE/);
  assert.match(await command(page), /^echo '{"query":"forward",.*"start":{"pose":{"x":/);
  const {pose} = await printed(page);
  near([pose.x, pose.y, pose.phi], there, 1e-6, 'the command');
  const second = await blank(browser);
  await second.page.goto(await linked(page));
  await settled(second.page, 0);
  await rested(second.page);
  const led = (await said(second.page)).pose;
  near([led.x, led.y, led.phi], there, 1e-6, 'a link leads elsewhere');
  await second.done();
  for (const tension of ['0.6', '0.7', '0.8']) await then(page, () => fill(page, 'inputs-0', tension));
  assert.ok(Math.abs((await here())[2] - there[2]) < 0.3, 'it left its branch');
  for (let i = 0; i < 4 && Math.abs((await here())[2] - before[2]) > 0.1; ++i) await then(page, () => page.locator('#undo').click());
  near(await here(), before, 1e-6, 'undo leads back');
  await done();
}
