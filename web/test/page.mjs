// node page.mjs SINEW CHROMIUM FOLDER: the page of sinew serve in a real browser; screenshots go to FOLDER.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {mkdirSync} from 'node:fs';
import {join} from 'node:path';
import {createInterface} from 'node:readline';
import {chromium} from 'playwright-core';

const [, , sinew, executablePath, folder] = process.argv;
mkdirSync(folder, {recursive: true});

async function serve(...options) {
  const server = spawn(sinew, ['serve', ...(options.length ? options : ['--port', '0']), '-q'], {stdio: ['ignore', 'pipe', 'inherit']});
  const url = await new Promise((resolve) => createInterface(server.stdout).once('line', resolve));
  return {server, url};
}

/** A page on which nothing may go wrong: no error on its console, no request to anyone else. */
async function open(browser, url, width, height, colorScheme) {
  const page = await browser.newPage({viewport: {width, height}, colorScheme});
  const wrong = [];
  page.on('console', (line) => line.type() === 'error' && wrong.push(line.text()));
  page.on('pageerror', (error) => wrong.push(error.message));
  page.on('request', (request) => {
    if (!request.url().startsWith(new URL(url).origin) && !/^(data|blob):/.test(request.url())) wrong.push(`foreign: ${request.url()}`);
  });
  await page.goto(url);
  await page.waitForSelector('html[data-answers]');
  return {page, wrong};
}

const answers = (page) => page.evaluate(() => Number(document.documentElement.dataset.answers));
const pose = (page) => page.locator('#answer table').first().innerText();
const picture = (page) => page.locator('#view canvas').screenshot();

/** Waits for the picture of an answer after so many. */
async function settled(page, after) {
  for (let i = 0; i < 500 && (await answers(page)) <= after; ++i) await page.waitForTimeout(10);
  assert.ok((await answers(page)) > after, 'no answer came');
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

async function everyRobot(browser, url, sizes) {
  const {robots} = await (await fetch(new URL('/api/robots', url))).json();
  for (const [width, height, theme] of sizes)
    for (const {name} of robots) {
      const {page, wrong} = await open(browser, `${url}#robot=${name}`, width, height, theme);
      await settled(page, 0);
      assert.match(await page.locator('.verdict').innerText(), /SOLVED/, name);
      const before = await picture(page), said = await page.locator('#answer').innerText(), count = await answers(page);
      const slider = page.locator('#inputs input[type=range]').first();
      await slider.focus();
      await slider.press('Shift+ArrowRight');
      await settled(page, count);
      assert.notEqual(await page.locator('#answer').innerText(), said, `${name}: the answer did not change`);
      assert.notDeepEqual(await picture(page), before, `${name}: the picture did not change`);
      const beyond = await page.evaluate(() => [document.documentElement.scrollWidth - innerWidth, document.documentElement.scrollHeight - innerHeight]);
      assert.deepEqual(beyond.map((by) => Math.max(by, 0)), [0, 0], `${name}: the page is larger than the window`);
      await page.screenshot({path: join(folder, `${name}-${width}-${theme}.png`)});
      assert.deepEqual(wrong, [], name);
      await page.close();
    }
}

/** What is typed, wrong and right; a link; units; a file that is dropped is a later test's. */
async function words(browser, url) {
  const {page, wrong} = await open(browser, `${url}#robot=3-rfr`, 1280, 800, 'light');
  const box = page.locator('#inputs-0');
  for (const [text, message] of [['12 deg', 'deg is no unit of length'], ['x', 'x is no number'], ['5 foo', 'foo is no unit; write mm']]) {
    await box.fill(text);
    await box.press('Enter');
    assert.equal(await page.locator('.row .why').first().innerText(), message);
    assert.equal(await box.getAttribute('aria-invalid'), 'true');
  }
  let count = await answers(page);
  await box.fill('0.192 m');
  await box.press('Enter');
  await settled(page, count);
  assert.equal(await box.inputValue(), '192.000');
  assert.match(await page.locator('#command').innerText(), /^sinew forward 3-rfr --inputs "0\.192, /);
  await page.waitForURL(/inputs=0\.192/);
  const shown = await pose(page), link = page.url();
  await page.locator('#units').click();
  assert.equal(await box.inputValue(), '0.192000');
  const second = await open(browser, link, 1280, 800, 'light');
  await settled(second.page, 0);
  assert.equal(await pose(second.page), shown, 'a link shows what it was copied from');
  count = await answers(page);
  await page.locator('#inputs-0').fill('0.4');
  await page.locator('#inputs-0').press('Enter');
  await settled(page, count);
  assert.doesNotMatch(await page.locator('.verdict').innerText(), /SOLVED/);
  await page.screenshot({path: join(folder, 'unreachable.png')});
  assert.deepEqual([...wrong, ...second.wrong], []);
  await page.close();
  await second.page.close();
}

/** Poses ask for inputs: in the plane, of three rods, of a platform held in all directions, of a serial robot. */
async function poses(browser, url) {
  for (const name of ['3-rfr', '3pfs-g2', '3prs', 'hexapod', 'nottingham-tpcj']) {
    const {page, wrong} = await open(browser, `${url}#robot=${name}`, 1280, 800, 'light');
    const before = await page.locator('#inputs-0').inputValue(), count = await answers(page);
    await page.getByRole('tab', {name: 'Pose'}).click();
    const isArm = name === 'nottingham-tpcj', sliders = page.locator('#pose input[type=range]');
    const slider = isArm ? sliders.nth(2) : sliders.first();  // a straight arm reaches no further
    await slider.focus();
    await slider.press(isArm ? 'Shift+ArrowLeft' : 'ArrowRight');
    await settled(page, count);
    await page.screenshot({path: join(folder, `pose-${name}.png`)});
    assert.match(await page.locator('.verdict').innerText(), /SOLVED/, name);
    assert.notEqual(await page.locator('#inputs-0').inputValue(), before, `${name}: the inputs did not change`);
    assert.deepEqual(wrong, []);
    await page.close();
  }
}

/** A file with an error says where; the picture waits; the mended file is drawn. */
async function file(browser, url) {
  const {page, wrong} = await open(browser, `${url}#robot=3-frr`, 1280, 800, 'light');
  await page.getByRole('tab', {name: 'File'}).click();
  const area = page.getByLabel('Robot file'), text = await area.inputValue(), before = await picture(page);
  await area.fill(text.replace('planar', 'plane'));
  await page.locator('#file li').first().waitFor();
  assert.match(await page.locator('#file li').first().innerText(), /^\d+:\d+ .*plan/);
  assert.match(await page.locator('#file p').innerText(), /last valid file/);
  assert.deepEqual(await picture(page), before);
  await page.screenshot({path: join(folder, 'file-error.png')});
  await page.locator('#file li button').first().click();
  const line = await area.evaluate((of) => of.value.slice(0, of.selectionStart).split('\n').length);
  assert.equal(line, text.slice(0, text.indexOf('planar')).split('\n').length);
  const count = await answers(page);
  await area.fill(text.replace(/radius: [0-9.]+ *m?m?/, 'radius: 70 mm'));
  await settled(page, count);
  assert.equal(await page.locator('#file li').count(), 0);
  assert.notDeepEqual(await picture(page), before);
  assert.deepEqual(wrong.filter((line) => !/422/.test(line)), []);  // browsers report the refusal themselves
  await page.close();
}

/** Rods give way under a load; legs that bear none have no tab for it. */
async function load(browser, url) {
  const {page, wrong} = await open(browser, `${url}#robot=3pfs-g2`, 1280, 800, 'light');
  const before = await pose(page), count = await answers(page);
  assert.match(await page.locator('.verdict').innerText(), /SOLVED, STABLE/);
  assert.match(await page.locator('#answer').innerText(), /to a fold\s+0\.\d+/);
  await page.getByRole('tab', {name: 'Load'}).click();
  await page.locator('#load-0').fill('2 N');
  await page.locator('#load-0').press('Enter');
  await settled(page, count);
  assert.notEqual(await pose(page), before);
  assert.match(await page.locator('#command').innerText(), /--wrench "2, 0, 0, 0, 0, 0"$/);
  await page.locator('#load-3').fill('2 N');
  await page.locator('#load-3').press('Enter');
  assert.equal(await page.locator('#load .why').nth(3).innerText(), 'N is no unit of moment');
  await page.screenshot({path: join(folder, 'load.png')});
  await page.locator('#robot').selectOption('3-rfr');
  await page.locator('#inputs').waitFor();
  await page.getByRole('tab', {name: 'Load'}).waitFor({state: 'hidden'});
  assert.deepEqual(wrong, []);
  await page.close();
}

/** A server that goes away and comes back, with none of its robots. */
async function connection(browser) {
  const first = await serve(), {page} = await open(browser, `${first.url}#robot=3-rfr`, 1280, 800, 'light');
  const gone = new Promise((done) => first.server.once('exit', done));
  first.server.kill('SIGINT');
  await gone;
  const slider = page.locator('#inputs input[type=range]').first();
  await slider.focus();
  await slider.press('ArrowRight');
  await page.locator('#status', {hasText: /NO CONNECTION \d+ s/}).waitFor();
  assert.ok(await page.evaluate(() => document.body.classList.contains('lost')));
  await page.screenshot({path: join(folder, 'no-connection.png')});
  const count = await answers(page), second = await serve('--port', new URL(first.url).port);
  await settled(page, count);
  assert.match(await page.locator('.verdict').innerText(), /SOLVED/);
  assert.match(await page.locator('#status').innerText(), /converged/);
  second.server.kill('SIGINT');
  await page.close();
}

/** From a slider's step to the picture of its answer [ms]. */
async function latency(browser, url) {
  const {page} = await open(browser, `${url}#robot=3-rfr`, 1280, 800, 'light');
  const times = await page.evaluate(async () => {
    const slider = document.querySelector('#inputs input[type=range]'), root = document.documentElement, times = [];
    for (let i = 0; i < 200; ++i) {
      const count = root.dataset.answers, begin = performance.now();
      slider.value = String(Number(slider.value) + (i % 40 < 20 ? 1e-4 : -1e-4));
      slider.dispatchEvent(new Event('input'));
      while (root.dataset.answers === count) await new Promise((next) => setTimeout(next, 0));
      times.push(performance.now() - begin);
    }
    return times.sort((a, b) => a - b);
  });
  console.log(`slider to new pose: median ${times[100].toFixed(1)} ms, 95 % ${times[190].toFixed(1)} ms`);
  const rate = await page.evaluate(async () => {
    const slider = document.querySelector('#inputs input[type=range]'), begin = performance.now(), first = window.__sinew.scene.frames;
    for (let i = 0; performance.now() < begin + 2000; ++i) {
      slider.value = String(Number(slider.value) + (i % 40 < 20 ? 1e-4 : -1e-4));
      slider.dispatchEvent(new Event('input'));
      await new Promise((next) => requestAnimationFrame(next));
    }
    return (window.__sinew.scene.frames - first) / (performance.now() - begin) * 1000;
  });
  console.log(`new poses drawn while it moves: ${rate.toFixed(0)} a second`);
  await page.close();
}

const {server, url} = await serve();
const browser = await chromium.launch({
  executablePath,
  args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update',
         '--disable-sync', '--enable-unsafe-swiftshader'],
});
try {
  await everyRobot(browser, url, [[1280, 800, 'light'], [390, 844, 'dark']]);
  await words(browser, url);
  await poses(browser, url);
  await file(browser, url);
  await load(browser, url);
  await connection(browser);
  await latency(browser, url);
} finally {
  await browser.close();
  server.kill('SIGINT');
}
