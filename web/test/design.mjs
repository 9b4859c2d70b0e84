// The Design screen, each part of it as people use it.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {answers, blank, differs, drawn, fill, linked, looks, numbers, open, picture, rested, same, settled, shot, sinew, tab, then, verdict} from './harness.mjs';

/** What is typed, wrong and right; links; units. */
export async function words(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr');
  const box = page.locator('#inputs-0');
  for (const [text, message] of [['12 deg', 'deg is no unit of length'], ['x', 'x is no number'], ['5 foo', 'foo is no unit; write mm']]) {
    await fill(page, 'inputs-0', text);
    assert.equal(await page.locator('.row .why').first().innerText(), message);
    assert.equal(await box.getAttribute('aria-invalid'), 'true');
  }
  await shot(page, 'wrong-word');
  await then(page, () => fill(page, 'inputs-0', '0.192 m'));
  assert.equal(await box.inputValue(), '192.000');
  assert.match(await page.locator('#command').innerText(), /^sinew forward 3-rfr --inputs "0\.192, /);
  await page.waitForURL(/inputs=0\.192/);
  await rested(page);
  const shown = await numbers(page), link = page.url(), second = await blank(browser);
  await page.locator('#units').click();
  assert.equal(await box.inputValue(), '0.192000');
  await second.page.goto(link);
  await settled(second.page, 0);
  await rested(second.page);
  assert.equal(await numbers(second.page), shown, 'a link shows what it was copied from');
  await second.done();
  await done();
}

/** A link holds all of it: model, load, camera, layers; it draws the same picture. */
export async function links(browser, url) {
  for (const hash of ['robot=3-rfr&inputs=0.19,0.189,0.188&load=0.01,0.01,0.0001&model=prb', 'robot=6-ufs&asked=pose&pose=0.01,0,0.19,0.2,1,0.1&layers=rods.lines.frames',
                      'robot=nottingham-tpcj&inputs=0.1,0.1,0,0.1,0,0,0,0,0.1,0&model=lsk', 'robot=3pfs-g2&inputs=0.44,0.42,0.41&load=1,0,-5,0,0,0']) {
    const first = await blank(browser), second = await blank(browser);
    await then(first.page, () => first.page.goto(`${url}#${hash}`));
    await first.page.locator('#view').press('ArrowRight');
    await first.page.evaluate(() => document.activeElement.blur());
    await rested(first.page);
    const link = await linked(first.page);
    assert.match(await verdict(first.page), /SOLVED/, hash);
    await then(second.page, () => second.page.goto(link));
    await rested(second.page);
    assert.equal(await numbers(second.page), await numbers(first.page), hash);
    const [one, other] = [await picture(first.page), await picture(second.page)];
    if (!one.equals(other)) await Promise.all([shot(first.page, 'link-first'), shot(second.page, 'link-second')]);
    same(other, one, hash);
    await first.done();
    await second.done();
  }
}

/** The command that is copied gives, in a shell, the numbers that are shown. */
export async function commands(browser, url) {
  const {page, done} = await blank(browser);
  for (const hash of ['robot=3-rfr&inputs=0.19,0.189,0.188', 'robot=3-rfr&asked=pose&pose=0.01,0,0.1&bending=1,-1,1', 'robot=6-ufs&asked=pose&pose=0.01,0,0.19,0.2,1,0.1',
                      'robot=3prs&asked=pose&pose=0.5,0.1,0.05', 'robot=hexapod&asked=pose&pose=0.01,0,0.4,0.1,0,0&load=0,0,-0.5,0,0,0', 'robot=3pfs-g2&inputs=0.44,0.42,0.41&load=1,0,-5,0,0,0',
                      'robot=3-frr&model=prb&joints=4&load=0.01,0,0', 'robot=hexapod-heavy&gravity=off', 'robot=nottingham-tpcj&inputs=0.1,0.1,0,0.1,0,0,0,0,0.1,0&model=lsk',
                      'robot=nottingham-neutral&asked=pose&pose=0.03,0.02,0.16']) {
    await then(page, () => page.goto(`${url}#${hash}`));
    await rested(page);
    assert.match(await verdict(page), /SOLVED/, hash);
    await page.locator('#copy').click();
    const text = await page.evaluate(() => navigator.clipboard.readText()), shown = await page.evaluate(() => window.__sinew.answer());
    const printed = execFileSync('/bin/sh', ['-c', `${text.replace(/^sinew/, `'${sinew}'`)} --json`], {encoding: 'utf8'}), answer = JSON.parse(printed);
    const all = (pose) => (pose.position ? [...pose.position, ...pose.quaternion] : [pose.x, pose.y, pose.phi]);
    const mine = all(shown.pose ?? shown.tip), its = all(answer.pose ?? answer.tip);
    for (const [i, value] of its.entries()) assert.ok(Math.abs(value - mine[i]) < 1e-8, `${text}\n${its}\n${mine}`);
  }
  await done();
}

/** Poses ask for inputs: in the plane, of three rods, of a platform held in all directions, of a serial robot. */
export async function poses(browser, url) {
  const {page, done} = await blank(browser);
  for (const name of ['3-rfr', '3pfs-g2', '3prs', 'hexapod', '6-ufs', 'nottingham-tpcj']) {
    await then(page, () => page.goto(`${url}#robot=${name}`));
    await rested(page);
    await tab(page, 'Pose');
    const isArm = name === 'nottingham-tpcj', sliders = page.locator('#pose input[type=range]');
    for (let i = 0; i < await sliders.count(); ++i) {
      if (isArm && i < 2) continue;  // a straight arm reaches no further
      const before = await page.locator('#inputs-0').inputValue();
      await then(page, () => sliders.nth(i).press(isArm ? 'Shift+ArrowLeft' : name === '6-ufs' && i === 3 ? 'Shift+ArrowRight' : 'ArrowRight'));
      assert.match(await verdict(page), /SOLVED/, name);
      const isTurn = i === 4 && name !== '6-ufs';  // the azimuth of no tilt
      if (!isTurn) assert.notEqual(await page.locator('#inputs-0').inputValue(), before, `${name}: the inputs did not change`);
    }
    assert.ok(await page.locator('#inputs .answered').count(), 'the answered side is marked');
    await rested(page);
    await shot(page, `pose-${name}`);
  }
  await then(page, () => page.goto(`${url}#robot=3-rfr`));
  await rested(page);
  const before = await picture(page);
  await tab(page, 'Pose');
  await then(page, () => page.getByRole('button', {name: 'leg 2 bends minus'}).click());
  differs(await picture(page), before);
  assert.match(await page.locator('#numbers').innerText(), /leg 2\s+-/);
  await then(page, () => page.getByRole('button', {name: 'Nearest'}).click());
  await then(page, () => fill(page, 'pose-0', '300 mm'));
  assert.equal(await verdict(page), 'UNREACHABLE');
  await rested(page);
  await shot(page, 'pose-unreachable');
  await then(page, () => page.locator('#verdict').getByRole('button', {name: /^Go to x = /}).click());
  assert.match(await verdict(page), /SOLVED/);
  await done();
}

/** Rods give way under a load; what bears none says so, or has no tab for it. */
export async function load(browser, url) {
  const {page, done} = await open(browser, url, '3pfs-g2');
  const before = await numbers(page);
  assert.equal(await verdict(page), 'SOLVED, STABLE');
  assert.match(before, /to a fold\s+0\.\d+/);
  await tab(page, 'Load');
  await then(page, () => fill(page, 'load-0', '2 N'));
  assert.notEqual(await numbers(page), before);
  assert.match(await page.locator('#command').innerText(), /--wrench "2, 0, 0, 0, 0, 0"$/);
  await rested(page);
  assert.match(await numbers(page), /[\d.]+ ×/);
  await fill(page, 'load-3', '2 N');
  assert.equal(await page.locator('#load .why').nth(3).innerText(), 'N is no unit of moment');
  await shot(page, 'load');
  await then(page, () => page.getByRole('button', {name: 'Zero'}).click());
  await then(page, () => fill(page, 'load-2', '-400 N'));
  assert.doesNotMatch(await verdict(page), /SOLVED, STABLE/);
  await rested(page);
  await shot(page, 'load-too-much');
  await then(page, () => page.locator('#robot').selectOption('3-rfr'));
  await tab(page, 'Load');
  await then(page, () => page.getByRole('button', {name: 'Take pseudo-rigid chains'}).click());
  await then(page, () => fill(page, 'load-0', '0.02'));
  assert.match(await page.locator('#command').innerText(), /--model prb --wrench "0\.02, 0, 0"$/);
  assert.match(await numbers(page), /Tensions \[N\]/);
  await rested(page);
  await shot(page, 'load-chains');
  await then(page, () => page.locator('#robot').selectOption('hexapod-heavy'));
  await tab(page, 'Load');
  const heavy = await numbers(page);
  await then(page, () => page.getByLabel('Gravity as in the file').click());
  assert.notEqual(await numbers(page), heavy);
  await then(page, () => page.locator('#robot').selectOption('3prs'));
  await page.getByRole('tab', {name: 'Load'}).waitFor({state: 'hidden'});
  await done();
}

/** Models, and numbers that are none. */
export async function models(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr'), before = await picture(page);
  await tab(page, 'Model');
  await then(page, () => page.getByRole('radio', {name: /^prb/}).click());
  assert.match(await page.locator('#command').innerText(), /--model prb$/);
  differs(await picture(page), before);
  await then(page, () => fill(page, 'model-joints', '3'));
  assert.match(await page.locator('#command').innerText(), /--set "legs\[2\]\.link\.joints=3"$/);
  await rested(page);
  await shot(page, 'model-prb');
  await fill(page, 'model-joints', '99');
  assert.equal(await page.locator('#model .why').first().innerText(), 'give a whole number from 1 to 32, or nothing');
  await then(page, () => page.getByRole('radio', {name: /^cc/}).click());
  await then(page, () => fill(page, 'model-iterations', '1'));
  await tab(page, 'Inputs');
  await then(page, () => fill(page, 'inputs-1', '199 mm'));
  assert.equal(await verdict(page), 'LIMIT REACHED');
  await shot(page, 'limit-reached');
  await then(page, () => page.locator('#robot').selectOption('nottingham-tpcj'));
  await then(page, () => fill(page, 'inputs-0', '20 deg'));
  const exact = await numbers(page);
  await tab(page, 'Model');
  await then(page, () => page.getByRole('radio', {name: /^lsk/}).click());
  assert.notEqual(await numbers(page), exact);
  await done();
}

/** How far one can go is there before one goes: bands with words, a click goes, the way back is a button. */
export async function response(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr');
  assert.equal(await page.locator('#strip .plot').getAttribute('data-samples') > 20, true);
  assert.match(await page.locator('#strip p').innerText(), /^UNREACHABLE from 1[67]\d\.\d+ mm to 1\d\d\.\d+ mm; UNREACHABLE from 2/);
  assert.match(await numbers(page), /ℓ₁ −[\d.]+ mm\s+UNREACHABLE/);
  const before = await page.locator('#inputs-0').inputValue(), plot = await page.locator('#strip .u-over').boundingBox();
  await then(page, () => page.mouse.click(plot.x + plot.width / 2, plot.y + 40));
  assert.notEqual(await page.locator('#inputs-0').inputValue(), before);
  assert.match(await verdict(page), /SOLVED/);
  await rested(page);  // it is drawn anew till then
  const drawn = await page.locator('#strip canvas').screenshot();
  await page.locator('#strip').getByRole('button', {name: 'y', exact: true}).click();
  differs(await page.locator('#strip canvas').screenshot(), drawn, 'the strip');
  await then(page, () => page.locator('#inputs input[type=range]').first().press('End'));
  assert.equal(await verdict(page), 'UNREACHABLE');
  await rested(page);
  await looks(page, 'unreachable');
  const back = page.locator('#verdict').getByRole('button', {name: /^Go to ℓ₁ = /});
  await then(page, () => back.click());
  assert.match(await verdict(page), /SOLVED/);
  await then(page, () => page.locator('#robot').selectOption('3pfs-g2'));
  await rested(page);
  await page.locator('#strip').getByRole('button', {name: 'energy'}).click();
  await shot(page, 'response-rods');
  await done();
}

/** Assembly modes, working modes and equilibria as pictures; a click goes to one. */
export async function others(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr');
  assert.match(await page.locator('#solutions h3').innerText(), /^Solutions \(2\)$/);
  const before = await numbers(page);
  await then(page, () => page.getByRole('button', {name: /^go to solution/}).first().click());
  assert.notEqual(await numbers(page), before);
  assert.match(await page.locator('#toast').innerText(), /no path was followed/);
  await rested(page);
  assert.match(await page.locator('#command').innerText(), /--start "/);
  await then(page, () => page.locator('#robot').selectOption('3pfs-g2'));
  await rested(page);
  await page.getByRole('button', {name: 'Look for others'}).click();
  await page.locator('#solutions h3', {hasText: 'Solutions (at least 8)'}).waitFor();
  assert.equal(await page.locator('.small').count(), 8);
  await shot(page, 'solutions');
  await tab(page, 'Pose');
  await then(page, () => page.locator('#robot').selectOption('6-ufs'));
  await then(page, () => page.locator('#pose input[type=range]').first().press('ArrowRight'));
  await rested(page);
  assert.match(await page.locator('#solutions h3').innerText(), /^Solutions \(64; the nearest 12 are drawn\)$/);
  await done();
}

/** A kept pose and another robot as ghosts, with the differences. */
export async function ghosts(browser, url) {
  const {page, done} = await open(browser, url, '3pfs-g2');
  await page.locator('#keep').click();
  await then(page, () => fill(page, 'inputs-0', '440'));
  assert.match(await numbers(page), /from the ghost[\s\S]*x\s+-?[\d.]+ mm \([−+][\d.]+ mm\)/);
  const haunted = await picture(page);
  await shot(page, 'ghost');
  await page.locator('#view').press('g');
  await drawn(page);
  differs(await picture(page), haunted);
  assert.doesNotMatch(await numbers(page), /ghost/);
  await page.locator('#against').selectOption('3pfs-g1');
  await page.locator('#numbers', {hasText: 'from the ghost'}).waitFor();
  await shot(page, 'compare');
  await done();
}

/** In place of all of the text. */
async function paste(page, area, text) {
  await page.evaluate((of) => navigator.clipboard.writeText(of), text);
  await area.focus();
  await page.keyboard.press('Control+a');
  await page.keyboard.press('Control+v');
}

/** A file with an error says where; the picture waits; the mended file is drawn; a number is dragged; undo, reload. */
export async function file(browser, url) {
  const {page, done} = await open(browser, url, '3-frr');
  await tab(page, 'File');
  const area = page.getByLabel('Robot file'), text = await page.evaluate(() => window.__sinew.file.text), before = await picture(page);
  assert.match(text, /planar/);
  await paste(page, area, text.replace('planar', 'plane'));
  await page.locator('#file li').first().waitFor();
  assert.match(await page.locator('#file li').first().innerText(), /^\d+:\d+ .*plan/);
  assert.match(await page.locator('#file p:not(.disk)').innerText(), /last valid file/);
  await page.locator('.cm-lintRange-error').first().waitFor();
  await page.locator('.cm-changed').first().waitFor();
  same(await picture(page), before);
  await page.locator('#file li button').first().click();
  await looks(page, 'file-error');
  assert.match(await page.evaluate(() => document.querySelector('.editor').shadowRoot.querySelector('.cm-activeLine, .cm-line.cm-changed')?.textContent ?? ''), /plane/);
  await then(page, () => paste(page, area, text.replaceAll('radius: 50 mm', 'radius: 70 mm')));
  assert.equal(await page.locator('#file li').count(), 0);
  differs(await picture(page), before);
  await then(page, () => page.locator('#file').getByRole('button', {name: 'Reload'}).click());
  assert.equal(await page.evaluate(() => window.__sinew.file.text), text);
  const place = await page.locator('.cm-line', {hasText: /^platform: .*\d/}).evaluate((line) => {  // of its first digit
    const walk = document.createTreeWalker(line, NodeFilter.SHOW_TEXT), range = document.createRange();
    while (walk.nextNode() && !/\d/.test(walk.currentNode.data));
    const at = walk.currentNode.data.search(/\d/);
    range.setStart(walk.currentNode, at);
    range.setEnd(walk.currentNode, at + 1);
    const {left, top, height} = range.getBoundingClientRect();
    return [left + 2, top + height / 2];
  });
  await page.keyboard.down('Alt');
  await page.mouse.move(...place);
  await page.mouse.down();
  await then(page, async () => {
    await page.mouse.move(place[0] + 40, place[1], {steps: 5});
    await page.mouse.up();
    await page.keyboard.up('Alt');
  });
  assert.notEqual(await page.evaluate(() => window.__sinew.file.text), text);
  await done(/422/);  // browsers report the refusal themselves
}

/** No robot yet: pictures of those that ship; a click opens one; a dropped file too. */
export async function start(browser, url) {
  const {page, done} = await blank(browser);
  await page.goto(url);
  await page.locator('.robot svg').nth(17).waitFor();
  await shot(page, 'start');
  await then(page, () => page.locator('.robot', {hasText: '6-UFS'}).first().click());
  assert.equal(await page.locator('#robot').inputValue(), '6-ufs');
  const text = await (await fetch(new URL('/api/robots/3-frr', url))).text();
  await then(page, () => page.evaluate((yaml) => {
    const data = new DataTransfer();
    data.items.add(new File([yaml], 'mine.yaml'));
    window.dispatchEvent(new DragEvent('drop', {dataTransfer: data, cancelable: true}));
  }, text));
  assert.match(await page.locator('#command').innerText(), /^sinew forward mine\.yaml /);
  await page.locator('#brand').click();
  await page.locator('.robot').first().waitFor();
  await done();
}

/** All of the main path by keys alone. */
export async function keyboard(browser, url) {
  const {page, done} = await blank(browser);
  await page.goto(`${url}#robot=3-rfr`);
  await settled(page, 0);
  await page.keyboard.press('/');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'robot');
  await then(page, () => page.keyboard.press('ArrowDown'));
  const until = async (is) => {
    for (let i = 0; i < 60; ++i) {
      await page.keyboard.press('Tab');
      if (await page.evaluate(is)) return;
    }
    assert.fail(`no way by Tab to ${is}`);
  };
  await until(() => document.activeElement.getAttribute('role') === 'tab');
  for (const name of ['Pose', 'Load', 'Model', 'File']) {
    await page.keyboard.press('ArrowRight');
    assert.equal(await page.evaluate(() => document.activeElement.textContent), name);
  }
  for (let i = 0; i < 4; ++i) await page.keyboard.press('ArrowLeft');
  await until(() => document.activeElement.type === 'range');
  const before = await page.locator('#inputs-0').inputValue();
  await then(page, () => page.keyboard.press('ArrowRight'));
  assert.notEqual(await page.locator('#inputs-0').inputValue(), before);
  await then(page, () => page.keyboard.press('Control+z'));
  assert.equal(await page.locator('#inputs-0').inputValue(), before);
  await then(page, () => page.keyboard.press('Control+Shift+Z'));
  assert.notEqual(await page.locator('#inputs-0').inputValue(), before);
  await until(() => document.activeElement.type === 'range');
  await page.keyboard.press('1');  // a digit opens the box
  assert.match(await page.evaluate(() => document.activeElement.id), /^inputs-\d$/);
  await page.keyboard.press('Escape');
  await page.locator('#view').focus();
  const seen = await picture(page);
  await page.keyboard.press('ArrowRight');
  await drawn(page);
  differs(await picture(page), seen);
  await then(page, () => page.keyboard.press('h'));
  await page.keyboard.press('?');
  await page.getByRole('dialog').waitFor();
  await shot(page, 'keys');
  await page.keyboard.press('Escape');
  await page.getByRole('dialog').waitFor({state: 'hidden'});
  await page.keyboard.press('u');
  assert.equal(await page.locator('#units').innerText(), 'm · rad');
  await page.keyboard.press('d');
  await page.keyboard.press('d');
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), 'dark');
  await page.keyboard.press('c');
  await page.locator('#toast', {hasText: 'pose copied'}).waitFor();
  assert.ok('x' in JSON.parse(await page.evaluate(() => navigator.clipboard.readText())));
  await page.keyboard.press('Control+c');
  await page.locator('#toast', {hasText: 'command copied'}).waitFor();
  await done();
}

/** The hand on the platform drags it: the pose is asked. */
export async function hand(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr'), box = await page.locator('#view').boundingBox(), count = await answers(page);
  const before = await numbers(page), isHand = () => page.locator('#view').evaluate((view) => view.style.cursor === 'grab');
  let [x, y] = [box.x + box.width / 2, box.y];
  for (; y < box.y + box.height && !(await isHand()); y += 10) await page.mouse.move(x, y);
  await page.mouse.move(x, y += 20);
  assert.ok(await isHand(), 'no hand on the platform');
  await page.mouse.down();
  await page.mouse.move(x + 15, y + 10, {steps: 4});
  await settled(page, count);
  await page.mouse.up();
  assert.notEqual(await numbers(page), before);
  assert.match(await page.locator('#command').innerText(), /^sinew inverse 3-rfr --pose/);
  await done();
}
