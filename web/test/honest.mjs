// What is shown is what was answered, and what names it names this: else a word says so, and there is a way on.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {answers, blank, differs, fill, hold, linked, numbers, open, picture, rested, same, settled, shot, sinew, tab, then, verdict} from './harness.mjs';

const command = (page) => page.locator('#command').innerText();
const value = (page, id) => page.locator(`#${id}`).inputValue();
const slider = (page, i = 0) => page.locator('#inputs input[type=range]').nth(i);
const way = (page, name) => page.locator('#verdict').getByRole('button', {name});

/** What the page says while its picture and numbers are not those of what is asked. */
async function isStale(page, word, why = /./) {
  await page.locator('#verdict strong', {hasText: word}).waitFor();
  assert.equal(await verdict(page), word);
  assert.equal(await page.locator('#verdict').getAttribute('data-state'), 'stale');
  assert.match(await page.locator('#verdict').innerText(), why);
  assert.ok(await page.locator('#answer.stale').count(), 'the numbers are not grey');
  assert.match(await page.locator('#hint').textContent(), new RegExp(`^${word}`));
  assert.equal(await page.locator('#inputs-0').inputValue().then((text) => (Number(text) / 1000).toFixed(4)), Number(/"([\d.]+),/.exec(await page.locator('#command').textContent())[1]).toFixed(4), 'the command is of other inputs');
}

/** Cancel, a busy server, one that closes connections, solves that were stopped, a page that fails: each has its word. */
export async function not_answered(browser, url) {
  const query = '**/api/query*', step = (page) => slider(page).press('ArrowRight');
  const answer = async (page, how) => {
    await page.unroute(query);
    if (how) await page.route(query, how);
  };
  for (const [width, height] of [[390, 844], [1280, 800]]) {
    const {page, done} = await open(browser, url, '3-rfr', {width, height}), before = await picture(page);
    await hold(page, query);
    await step(page);
    await page.locator('#verdict strong', {hasText: 'SOLVING'}).waitFor();
    assert.ok(await page.locator('#answer.stale').count());
    await shot(page, `solving-${width}`);
    await page.locator('#verdict').getByRole('button', {name: 'Cancel'}).click();
    await isStale(page, 'NOT ANSWERED', /cancelled/);
    differs(await picture(page), before, 'cancelled');
    await shot(page, `not-answered-${width}-light`);
    await page.emulateMedia({colorScheme: 'dark'});
    await shot(page, `not-answered-${width}-dark`);
    await answer(page, null);
    await then(page, () => way(page, 'Ask again').click());
    assert.match(await verdict(page), /SOLVED/);
    assert.equal(await page.locator('#answer.stale').count(), 0);
    await done();
  }
  const {page, done} = await open(browser, url, '3-rfr');
  for (const status of [503, 429]) {
    const count = await answers(page);
    await answer(page, (route) => route.fulfill({status, headers: {'Retry-After': '1'}, json: {error: {code: 'busy', where: 'query', message: 'try again'}}}));
    await step(page);
    await isStale(page, 'NOT ANSWERED', /the server is busy, asked again in \d+ s/);
    await answer(page, null);
    await settled(page, count);  // by itself
    assert.match(await verdict(page), /SOLVED/);
  }
  let closed = 0;
  await answer(page, (route) => (closed++ === 0 ? route.abort('connectionclosed') : route.continue()));
  await then(page, () => step(page));
  assert.match(await verdict(page), /SOLVED/);
  assert.ok(await page.locator('#lost').isHidden(), 'one closed connection is no lost server');
  const says = (given) => answer(page, (route) => route.fulfill({json: JSON.parse(route.request().postData()).map(() => given)}));
  await says({status: 'stopped', message: 'stopped after 5 s', iterations: 3});
  await then(page, () => step(page));
  await isStale(page, 'STOPPED', /stopped after 5 s[\s\S]*Ask again[\s\S]*Back to the last solved pose/);
  await shot(page, 'stopped');
  await says({error: {code: 'too_slow', where: 'query', message: 'the request took 30 s'}});
  await then(page, () => step(page));
  await isStale(page, 'STOPPED');
  await says({status: 'bad_input', message: 'three numbers are needed'});
  await then(page, () => step(page));
  assert.equal(await verdict(page), 'BAD INPUT');
  await says(null);
  await step(page);
  await page.locator('#verdict strong', {hasText: 'INTERNAL ERROR'}).waitFor();
  assert.match(await page.locator('#verdict').innerText(), /TypeError/);
  assert.ok(await page.locator('#lost').isHidden(), 'a mistake of the page is no lost connection');
  await shot(page, 'internal-error');
  await answer(page, null);
  await then(page, () => step(page));
  assert.match(await verdict(page), /SOLVED/);
  await done(/503|429|ERR_CONNECTION_CLOSED|TypeError/);
}

/** Letters are letters where they are written. */
export async function letters(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr'), all = ['h', 'g', 'c', 'f', '1', '2', 'o', 'p', 'u', 'd', '[', ']', '?', '/'];
  let saved = 0;
  page.on('download', () => ++saved);
  await then(page, () => slider(page).press('ArrowRight'));
  await rested(page);
  const state = () => page.evaluate(() => [document.getElementById('theme').textContent, document.getElementById('units').textContent, document.body.className,
    document.getElementById('keep').getAttribute('aria-pressed'), document.querySelectorAll('dialog[open]').length, document.getElementById('toast').textContent].join());
  const before = await state(), said = await command(page);
  const type = async (what) => {
    for (const key of all) await page.keyboard.press(key);
    assert.equal(await state(), before, what);
    assert.equal(await command(page), said, what);
  };
  for (const [name, id] of [['Inputs', 'inputs-0'], ['Pose', 'pose-0'], ['Model', 'model-iterations']]) {
    await tab(page, name);
    await page.locator(`#${id}`).focus();
    await type(id);
    await page.locator(`#${id}`).fill(await page.locator(`#${id}`).evaluate((box) => box.defaultValue || ''));
    await page.locator(`#${id}`).evaluate((box) => { box.value = ''; });
  }
  await tab(page, 'File');
  await page.getByLabel('Robot file').focus();
  const file = await page.evaluate(() => window.__sinew.file.text);
  await page.keyboard.press('Control+a');
  await type('the file');
  await then(page, () => page.locator('#file').getByRole('button', {name: 'Reload'}).click());
  assert.equal(await page.evaluate(() => window.__sinew.file.text), file);
  await page.locator('#view').focus();
  await page.keyboard.press('/');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'robot');
  await then(page, async () => {
    await page.keyboard.press('h');  // the first that begins with it
    await page.keyboard.press('p');
  });
  assert.match(await value(page, 'robot'), /^h/);
  await page.locator('#against').focus();
  for (const key of ['p', 'u', 'd', '[']) await page.keyboard.press(key);
  assert.equal(await state(), before);
  assert.equal(saved, 0, 'a picture was saved');
  await done(/422/);
}

const textIn = (bytes) => {
  const at = bytes.indexOf('iTXt');
  return bytes.subarray(at + 4, at + 4 + bytes.readUInt32BE(at - 4)).toString('utf8').replace(/^sinew\0+/, '');
};

async function change(page, from, to) {
  const text = await page.evaluate(() => window.__sinew.file.text);
  assert.ok(text.includes(from), from);
  await page.evaluate((of) => navigator.clipboard.writeText(of), text.replace(from, to));
  await page.getByLabel('Robot file').focus();
  await page.keyboard.press('Control+a');
  await page.keyboard.press('Control+v');
}

/** A robot that was edited is another one, for the title, the command, the link and the picture that is saved; it outlives the page. */
export async function edited(browser, url) {
  const folder = mkdtempSync(join(tmpdir(), 'sinew-')), {page, done} = await open(browser, url, '3-frr');
  const checked = async (what) => {  // the command gives what is shown
    await rested(page);
    const answer = await page.evaluate(() => window.__sinew.answer()), text = (await command(page)).replace(/^sinew/, `'${sinew}'`);
    const printed = JSON.parse(execFileSync('/bin/sh', ['-c', `${text} --json`], {encoding: 'utf8', cwd: folder}));
    for (const key of ['x', 'y', 'phi']) assert.ok(Math.abs(printed.pose[key] - answer.pose[key]) < 1e-9, `${what}: ${text}`);
  };
  const png = async () => {
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('#view').press('p')]);
    return [download.suggestedFilename(), textIn(readFileSync(await download.path()))];
  };
  const reload = async () => {
    await page.reload();
    await settled(page, 0);
  };
  await tab(page, 'File');
  await then(page, () => change(page, 'radius: 50 mm}', 'radius: 45 mm}  # smaller'));
  assert.match(await command(page), /^sinew forward 3-frr .* --set "platform\.radius=45 mm"$/);
  assert.equal(await page.locator('#robot option:checked').innerText(), '3-FRR (modified)');
  assert.match(await page.title(), /^3-frr \(modified\)/);
  await tab(page, 'Inputs');
  await then(page, () => fill(page, 'inputs-0', '195 mm'));
  await checked('values');
  assert.deepEqual(await png(), ['3-frr-modified.png', await command(page)]);
  await shot(page, 'modified');
  const shown = await numbers(page), link = await linked(page), second = await blank(browser);
  await then(second.page, () => second.page.goto(link));
  await rested(second.page);
  assert.equal(await numbers(second.page), shown, 'a link shows what it was copied from');
  assert.match(await second.page.title(), /modified/);
  await second.done();
  await reload();
  await rested(page);
  assert.equal(await numbers(page), shown);
  assert.match(await page.evaluate(() => window.__sinew.file.text), /radius: 45 mm} {2}# smaller/, 'a draft outlives the page');

  await tab(page, 'File');
  await then(page, () => change(page, 'angle: 330 deg}, direction: 200 deg}', 'angle: 330 deg}, direction: 200 deg}, link: {tendon_offset: 4 mm}'));
  await page.locator('#needs', {hasText: 'save 3-frr-modified.yaml'}).waitFor();
  assert.match(await command(page), /^sinew forward 3-frr-modified\.yaml --inputs [^-]*(--start "[^"]*")?$/);
  const [file] = await Promise.all([page.waitForEvent('download'), page.locator('#needs').click()]);
  assert.equal(file.suggestedFilename(), '3-frr-modified.yaml');
  await file.saveAs(join(folder, '3-frr-modified.yaml'));
  await checked('more than values');
  const [, words] = await png();
  assert.ok(words.startsWith(await command(page)) && words.includes('tendon_offset: 4 mm'), words);
  await shot(page, 'modified-file');
  const more = await numbers(page), changed = await linked(page), stranger = await blank(browser);
  await stranger.page.goto(changed);
  await stranger.page.locator('#status', {hasText: 'the link shows another 3-frr than is here'}).waitFor();
  await stranger.done();
  await change(page, 'planar', 'plane');  // no robot any more
  await page.locator('#file li').first().waitFor();
  await reload();
  await tab(page, 'File');
  await page.locator('#file li').first().waitFor();
  await rested(page);
  assert.equal(await numbers(page), more, 'the last valid robot is shown');
  assert.match(await page.evaluate(() => window.__sinew.file.text), /plane/);
  await then(page, () => page.locator('#robot').selectOption('3-rfr'));
  assert.match(await command(page), /^sinew forward 3-rfr /);
  await then(page, () => page.locator('#robot').selectOption('3-frr'));
  assert.match(await command(page), /^sinew forward 3-frr --inputs/);
  assert.equal(await page.locator('#robot option:checked').innerText(), '3-FRR');
  assert.match(await page.locator('#file .disk').innerText(), /changes of an earlier visit/);
  await page.locator('#file').getByRole('button', {name: 'Drop them'}).click();
  await page.locator('#file .disk').waitFor({state: 'hidden'});
  rmSync(folder, {recursive: true});
  await done(/422/);
}

/** A solution that was chosen is in the link, in the command and in undo; sliders are undone one by one; a comparison goes along. */
export async function choices(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr'), first = await numbers(page);
  const go = page.getByRole('button', {name: /^go to solution/}).first();
  await then(page, () => go.click());
  await rested(page);
  const other = await numbers(page), second = await blank(browser);
  assert.notEqual(other, first);
  const link = await linked(page);
  await then(second.page, () => second.page.goto(link));
  await rested(second.page);
  assert.equal(await numbers(second.page), other, 'the link shows another solution');
  await second.done();
  const count = await answers(page), look = page.getByRole('button', {name: 'Look for others'});
  if (await look.isVisible()) await look.click();  // where looking has taken long before, the page leaves it to its user
  await go.waitFor();
  const held = await hold(page);
  await go.click();
  await page.locator('#undo').click();  // while that is on its way
  await held.release();
  await settled(page, count + 1);
  await rested(page);
  assert.equal(await numbers(page), other, 'an answer that came late leads away');
  await then(page, () => page.locator('#undo').click());
  await rested(page);
  assert.equal(await numbers(page), first, 'undo keeps the solution');
  const at = [await value(page, 'inputs-0'), await value(page, 'inputs-1')];
  for (const i of [0, 0, 1, 1]) await then(page, () => slider(page, i).press('ArrowRight'));
  assert.notEqual(await value(page, 'inputs-1'), at[1]);
  const moved = await value(page, 'inputs-0');
  await then(page, () => page.locator('#undo').click());
  assert.deepEqual([await value(page, 'inputs-0'), await value(page, 'inputs-1')], [moved, at[1]], 'two sliders were undone at once');
  await then(page, () => page.locator('#undo').click());
  assert.equal(await value(page, 'inputs-0'), at[0]);
  await page.locator('#against').selectOption('3-rfr');  // itself
  for (let i = 0; i < 3; ++i) await then(page, () => slider(page, i).press('ArrowRight'));
  await page.locator('#numbers', {hasText: 'from the ghost, 3-rfr'}).waitFor();
  assert.match(await numbers(page), /x\s+\S+ mm \([+−]0\.000 mm\)\s+y\s+\S+ mm \([+−]0\.000 mm\)/, 'the ghost is elsewhere');
  await then(page, () => page.locator('#robot').selectOption('6-ufs'));
  await tab(page, 'Pose');
  await then(page, () => page.locator('#pose input[type=range]').first().press('ArrowRight'));
  await rested(page);
  if (await look.isVisible()) await look.click();
  const isShown = page.locator('.small[aria-current="true"]');
  const was = await isShown.getAttribute('aria-label'), all = await page.locator('.small').count(), before = await picture(page);
  assert.equal(all, 12);
  assert.equal(await isShown.count(), 1);
  await then(page, () => page.getByRole('button', {name: /^go to solution/}).last().click());
  await rested(page);
  differs(await picture(page), before);
  await then(page, () => page.locator('#undo').click());
  await rested(page);
  same(await picture(page), before);
  if (await look.isVisible()) await look.click();
  assert.equal(await isShown.getAttribute('aria-label'), was);
  await done();
}

/** The strip breaks where solutions jump, and reaches to where the value is. */
export async function reaches(browser, url) {
  const {page, done} = await open(browser, url, 'hexapod&inputs=0.4053,0.4458,0.3648,0.4458,0.3648,0.4458');
  assert.match(await page.locator('#strip p').innerText(), /JUMP from 35\d\.\d+ mm to 35\d\.\d+ mm/);
  assert.match(await numbers(page), /ℓ?L?₁ −[\d.]+ mm\s+JUMP/);
  await shot(page, 'jump');
  await then(page, () => page.locator('#robot').selectOption('3pfs-g2'));
  await then(page, () => fill(page, 'inputs-0', '600 mm'));
  await rested(page);
  assert.equal(Number(await slider(page).inputValue()), 0.6);
  assert.equal((await page.locator('#strip .plot').getAttribute('data-ends')).split(' ')[1], '0.6');
  await shot(page, 'beyond');
  await done();
}

/** A drag out of reach leads back; a third search does what the first did; text is copied where no page may write to the clipboard. */
export async function ways_back(browser, url) {
  const {page, done} = await blank(browser, {isOwn: true});
  await page.addInitScript(() => Object.defineProperty(navigator, 'clipboard', {value: undefined}));
  await page.goto(`${url}#robot=3-rfr`);
  await settled(page, 0);
  await rested(page);
  const box = await page.locator('#view').boundingBox(), isHand = () => page.locator('#view').evaluate((view) => view.style.cursor === 'grab'), shown = await numbers(page);
  let [x, y] = [box.x + box.width / 2, box.y];
  for (; y < box.y + box.height && !(await isHand()); y += 10) await page.mouse.move(x, y);
  await page.mouse.move(x, y += 20);
  await page.mouse.down();
  await page.mouse.move(box.x + 20, box.y + 20, {steps: 8});
  await page.locator('#verdict strong', {hasText: 'UNREACHABLE'}).waitFor();
  await page.mouse.up();
  await rested(page);
  await shot(page, 'dragged-away');
  await then(page, () => way(page, 'Back to the last solved pose').click());
  assert.match(await verdict(page), /SOLVED/);
  assert.notEqual(await numbers(page), shown);
  await rested(page);
  const said = await command(page);
  await page.locator('#copy').click();
  await page.locator('#toast', {hasText: 'command copied'}).waitFor();
  await tab(page, 'Pose');
  await page.locator('#pose-0').focus();
  await page.locator('#pose-0').fill('');
  await page.keyboard.press('Control+v');
  assert.equal(await value(page, 'pose-0'), said);
  await page.locator('#pose-0').evaluate((one) => { one.value = ''; });
  await page.evaluate(() => { document.execCommand = () => false; });
  await page.locator('#copy').click();
  assert.equal(await page.locator('dialog.copy textarea').inputValue(), said);
  await shot(page, 'copy-by-hand');
  await page.keyboard.press('Escape');

  await then(page, () => page.locator('#robot').selectOption('3pfs-g2'));
  await rested(page);
  const look = page.getByRole('button', {name: 'Look for others'});
  for (let i = 0; i < 3; ++i) {
    await look.waitFor();
    await page.evaluate(() => {
      for (const name of ['Look for others', 'Cancel']) [...document.querySelectorAll('#solutions button')].find((one) => one.textContent === name).click();
    });
  }
  await page.route('**/api/jobs', (route) => route.fulfill({status: 503, json: {error: {code: 'busy', where: 'job', message: 'try again'}}}));
  await look.click();
  await page.locator('#solutions h3', {hasText: 'the server is busy'}).waitFor();
  await page.unroute('**/api/jobs');
  await look.click();
  await page.locator('#solutions h3', {hasText: 'Solutions (at least 8)'}).waitFor();
  await done(/503/);
}

/** Each button does something that is seen. */
export async function buttons(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr');
  page.on('download', () => page.evaluate(() => ++window.changes).catch(() => undefined));
  await page.evaluate(() => {
    window.changes = 0;
    document.getElementById('chooser').addEventListener('click', (event) => {
      ++window.changes;
      event.preventDefault();
    });
    new MutationObserver(() => ++window.changes).observe(document, {subtree: true, childList: true, attributes: true, characterData: true});
  });
  for (const name of ['Inputs', 'Pose', 'Load', 'Model', 'File']) {
    await tab(page, name);
    await page.waitForTimeout(150);
    for (const one of await page.locator('button:visible:enabled').elementHandles()) {
      if (!(await one.isVisible()) || !(await one.isEnabled().catch(() => false))) continue;
      const what = await one.evaluate((of) => of.outerHTML);
      if (/role="tab"|aria-current|id="brand"/.test(what)) continue;
      if (name !== 'Inputs' && !(await one.evaluate((of) => of.closest('[role=tabpanel]')))) continue;
      if (/>Fit</.test(what)) await page.locator('#view').press('+');
      await page.waitForTimeout(30);
      await page.evaluate(() => { window.changes = 0; });
      const frames = await page.evaluate(() => window.__sinew.scene.frames);
      await one.click();
      let isDone = false;
      for (let i = 0; i < 200 && !isDone; ++i) {
        isDone = await page.evaluate((count) => window.changes > 0 || window.__sinew.scene.frames > count, frames);
        if (!isDone) await page.waitForTimeout(20);
      }
      assert.ok(isDone, `does nothing: ${what}`);
      if (await page.locator('dialog[open]').count()) await page.keyboard.press('Escape');
    }
  }
  assert.deepEqual(await page.locator('button:disabled:visible').evaluateAll((all) => all.map((one) => one.textContent).filter((text) => text !== 'shown' && !/^[a-zκφθ]/.test(text))), []);
  assert.doesNotMatch(await page.locator('body').innerText(), /Operate|Trajectory|Study|Studies/);
  await done();
}

/** Small pictures: bodies are outlines of what they are, arcs are round. */
export async function small_pictures(browser, url) {
  const {page, done} = await blank(browser, {deviceScaleFactor: 2});
  await page.goto(url);
  await page.locator('.robot svg').nth(17).waitFor();
  assert.equal(await value(page, 'robot'), '', 'a robot is named and none is open');
  for (const body of await page.locator('.sk-body').all()) assert.equal(await body.evaluate((one) => getComputedStyle(one).fill), 'none');
  const arcs = await page.locator('.robot', {hasText: 'three-arcs'}).locator('.sk-rod').first().getAttribute('d');
  assert.ok(arcs.split('L').length > 30, 'an arc is drawn with corners');
  await then(page, () => page.goto(`${url}#robot=three-arcs&inputs=1,0,1,1,1,2`));
  await rested(page);
  assert.equal(await page.locator('#strip p').innerText(), 'solved over the whole range of S1 θ', 'an orientation has two quaternions, and no jump between them');
  await shot(page, 'three-arcs-twice');
  await done();
}
