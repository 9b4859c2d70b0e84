// The source LOG of the screen Operate: a recording of the real demonstration (tests/data/recording), replayed, damaged, and as a report.
import assert from 'node:assert/strict';
import {copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {audit, blank, drawn, fits, folder, linked, serve, shot} from './harness.mjs';
import {framer, standIn} from './stand_in.mjs';

const data = new URL('../../tests/data/recording/', import.meta.url), name = 'nottingham-tpcj', text = readFileSync(new URL(`${name}.csv`, data), 'utf8');
const sizes = [[1280, 800], [390, 844]], themes = ['light', 'dark'];
const lines = text.split('\n'), first = lines.findIndex((line) => line.startsWith('time[s]')) + 1;

const until = async (page, is, ...values) => {
  for (let tries = 0; !await page.evaluate(is, ...values); ++tries) {
    assert.ok(tries < 1200, `it did not come: ${is}`);
    await new Promise((next) => setTimeout(next, tries < 20 ? 10 : 100));
  }
  await drawn(page);
};
const frame = (page) => page.evaluate(() => window.__sinew.operate.frame);
const words = async (page) => (await frame(page)).sections.map(({word}) => word);
const at = (page, time) => until(page, (t) => Math.abs((window.__sinew?.operate?.frame?.time ?? -1) - t) < 0.06 && !window.__sinew.operate.subject.isLate, time);
const bar = (page, title) => page.locator('#op-bar').getByRole('button', {name: title});

let place = null;

/** A server without a device, and a folder with the recording. */
async function recorded() {
  if (place) return place;
  const path = mkdtempSync(join(tmpdir(), 'sinew-log-'));
  process.once('exit', () => rmSync(path, {recursive: true, force: true}));
  for (const file of [`${name}.csv`, `${name}-001.png`]) copyFileSync(new URL(file, data), join(path, file));
  writeFileSync(join(path, 'later-broken.csv'), `${lines.slice(0, first).join('\n').replace('version 1', 'version 7')}\n`);
  const {server, url} = await serve('--record', path);
  server.unref();  // it ends with this process
  server.stdout.unref();
  place = {url, path};
  return place;
}

async function replay(browser, more = '', options = {}) {
  const {url} = await recorded(), opened = await blank(browser, options);
  await opened.page.goto(`${url}#recording=${name}${more}`);
  await until(opened.page, () => !!window.__sinew?.operate?.frame);
  return opened;
}

const drop = (page, file, content) => page.locator('#chooser').setInputFiles({name: file, mimeType: 'text/csv', buffer: Buffer.from(content)});

/** As it was at a time: states, banner, events, pictures, at both sizes in both themes. What a link says is what is seen. */
export async function log_looks(browser) {
  const states = {moving: 1.2, cut: 4.3, over: 6.5, blind: 7.1}, of = {cut: ['EXACT', 'EXACT', 'PARTLY SLACK', 'EXACT', 'EXACT'], over: ['EXACT', 'OVER-TENSIONED', 'EXACT', 'EXACT', 'EXACT'], blind: Array(5).fill('NO DATA')};
  const says = {moving: /^ALL SECTIONS EXACT/, cut: /^S3 PARTLY SLACK[^]*Look at tendons? [^]*: no tension\./, over: /^S2 OVER-TENSIONED[^]*Pay out tendons? [^]*: over 20 N\./, blind: /^NO DATA/};
  for (const [width, height] of sizes) for (const [what, time] of Object.entries(states)) {
    const {page, done} = await replay(browser, `&t=${time}&section=1`, {width, height});
    await at(page, time);
    await page.locator('.section.chosen').waitFor();
    assert.deepEqual(await words(page), of[what] ?? Array(5).fill('EXACT'));
    assert.match(await page.locator('#op-banner .words').innerText(), says[what], 'in the words of the log');
    if (what !== 'moving' && width > 720) await until(page, () => document.querySelector('.kept-picture img')?.naturalWidth === 160);
    assert.match(await page.locator('#source').innerText(), /^LOG nottingham-tpcj ×1$/);
    for (const theme of themes) {
      await page.emulateMedia({colorScheme: theme});
      await drawn(page);
      await shot(page, `log-${what}-${width}-${theme}`);
      if (what === 'over') await audit(page, `log ${width} ${theme}`);
    }
    await fits(page);
    const seen = await frame(page), address = await linked(page);
    assert.match(address, new RegExp(`recording=${name}`));
    await page.goto('about:blank');
    await page.goto(address);
    await at(page, time);
    const again = await frame(page);
    assert.deepEqual([again.sections, again.tip, again.alarm], [seen.sections, seen.tip, seen.alarm], 'a link reproduces the view');
    await done();
  }
}

/** Keys, the slider, play, events as of a time; the numbers are those of the file, diagrams those of the server. */
export async function log_time(browser) {
  const {page, done} = await replay(browser), entries = () => page.locator('#op-events li').allInnerTexts();
  assert.deepEqual(await words(page), Array(5).fill('EXACT'));
  assert.equal((await entries()).length, 0, 'what comes later has not happened yet');
  await page.locator('#op-view').focus();
  await page.keyboard.press('n');
  await until(page, () => window.__sinew.operate.frame.sections[2].word === 'PARTLY SLACK');
  await page.keyboard.press('n');
  await until(page, () => window.__sinew.operate.frame.sections[1].word === 'OVER-TENSIONED');
  const over = await page.evaluate(() => window.__sinew.operate.replayed.alarms.find(({word}) => word === 'OVER-TENSIONED').from);
  await page.evaluate((time) => window.__sinew.operate.subject.go(time), over);
  await at(page, over);
  assert.match((await entries())[0], /S2 OVER-TENSIONED: Pay out/);
  const count = (await entries()).length;
  await page.evaluate(() => window.__sinew.operate.subject.go(2.8));
  await at(page, 2.8);
  assert.match((await entries())[0], /nottingham-tpcj-001\.png/, 'events go back with the time');
  assert.ok((await entries()).length < count);
  const now = await frame(page), row = await page.evaluate(() => window.__sinew.operate.replayed.rowAt(2.8));
  assert.deepEqual(now.sections[2].changes, await page.evaluate((k) => [1, 2, 3].map((i) => window.__sinew.operate.replayed.column(`S2_change_${i}`)[k]), row));
  const {robot, described} = await page.evaluate(() => ({robot: window.__sinew.operate.opened.robot.handle, described: window.__sinew.operate.opened.described.answer.sections.length}));
  assert.equal(described, 5);
  const [told] = await (await fetch(new URL(`/api/query?robot=${robot}`, page.url()), {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify([{query: 'diagram', section: 2, model: 'pcc', changes: now.sections.slice(0, 3).map(({changes}) => changes)}])})).json();
  assert.deepEqual([now.sections[2].point, now.sections[2].slack, now.sections[2].class], [told.point, told.slack, told.class]);
  // a row on, and back; ten
  const time = () => page.evaluate(() => window.__sinew.operate.subject.at), times = await page.evaluate(() => [...window.__sinew.operate.replayed.times]);
  await page.keyboard.press('.');
  assert.equal(await time(), times[row + 1]);
  await page.keyboard.press('Shift+Period');
  assert.equal(await time(), times[row + 11]);
  await page.keyboard.press(',');
  assert.equal(await time(), times[row + 10]);
  // play, faster, to its end
  await page.keyboard.press('+');
  await page.keyboard.press('+');
  assert.match(await page.locator('#source').innerText(), /×4$/);
  await page.keyboard.press(' ');
  await bar(page, /Pause/).waitFor();
  await bar(page, /Play/).waitFor();
  assert.equal(await time(), await page.evaluate(() => window.__sinew.operate.replayed.duration));
  // the slider
  const slider = page.getByRole('slider', {name: 'Time'}), box = await slider.boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  assert.ok(Math.abs(await time() / await page.evaluate(() => window.__sinew.operate.replayed.duration) - 0.5) < 0.05);
  // the arm as large as the page
  await page.getByRole('button', {name: 'Full'}).click();
  await drawn(page);
  const [arm, line] = [await page.locator('#op-arm').boundingBox(), await page.locator('#op-bar').boundingBox()];
  assert.ok(arm.width > 1200 && arm.height > 500 && arm.y + arm.height <= line.y, 'it has the place of all else');
  assert.ok(await page.locator('.kept-picture').isHidden());
  await page.getByRole('button', {name: 'Full'}).click();
  // nothing is set in what was
  await page.keyboard.press('j');
  assert.ok(await page.locator('#op-jog').isHidden() && await page.locator('.jog-opener').isHidden());
  await page.locator('.plot-of').first().click();
  await page.locator('#op-notice', {hasText: 'this is a recording'}).waitFor();
  await page.keyboard.press('l');
  await page.locator('.drawer', {hasText: 'table FAA74276'}).waitFor();
  await shot(page, 'log-drawer');
  await audit(page, 'drawer of a recording');
  await done();
}

/** What takes long to be answered fades, and only the newest is asked. */
export async function log_slow(browser) {
  const {page, done} = await replay(browser, '&t=1');
  await at(page, 1);
  let asked = 0;
  await page.route('**/api/query*', async (route) => {
    ++asked;
    await new Promise((next) => setTimeout(next, 400));
    await route.continue().catch(() => undefined);
  });
  for (const time of [1.2, 1.4, 2.0, 2.5, 3.0]) await page.evaluate((to) => window.__sinew.operate.subject.go(to), time);
  await until(page, () => window.__sinew.operate.subject.isStale);
  assert.ok((await frame(page)).time <= 1.2, 'the last picture stays');
  await at(page, 3.0);
  assert.ok(!await page.evaluate(() => window.__sinew.operate.subject.isStale));
  assert.ok(asked <= 3, `${asked} questions for five times`);
  await done();
}

/** From the list of the server, and back to the robot that was open. */
export async function log_list(browser) {
  const {url} = await recorded();
  for (const [width, height] of sizes) {
    const {page, done} = await blank(browser, {width, height, theme: width < 720 ? 'dark' : 'light'});
    await page.goto(`${url}#robot=four-tendon-neutral&screen=operate`);
    await until(page, () => !!window.__sinew?.operate?.frame);
    await page.getByRole('button', {name: 'Recordings'}).click();
    const dialog = page.locator('.recordings-dialog');
    await dialog.getByText('OVER-TENSIONED').waitFor();
    assert.equal(await dialog.locator('li').count(), 2);
    await shot(page, `log-list-${width}`);
    await audit(page, 'list of recordings');
    await dialog.locator('li button').nth(1).click();
    await dialog.getByText('found version 7; this page reads version 1').waitFor();
    await dialog.getByRole('button', {name: 'Close'}).click();
    await page.getByRole('button', {name: 'Recordings'}).click();
    await dialog.locator('li button').first().click();
    await until(page, () => !!window.__sinew.operate.replayed && window.__sinew.operate.frame?.sections.length === 5);
    await bar(page, 'Close').click();
    await until(page, () => !window.__sinew.operate.replayed && !!window.__sinew.operate.frame);
    assert.equal(await page.locator('#source').innerText(), 'SLIDERS');
    assert.match(await linked(page), /robot=four-tendon-neutral/);
    await done();
  }
  const {page, done} = await blank(browser);  // where nothing is open there is nothing to go back to
  await page.goto(`${url}#recording=${name}&t=2`);
  await at(page, 2);
  await bar(page, 'Close').click();
  await page.locator('#start').waitFor();
  await page.goto(`${url}#recording=none-such`);
  await page.locator('.recordings-dialog', {hasText: 'no recording has this name'}).waitFor();
  await done(/404/);
}

/** Files of this computer: whole, damaged, of another robot, of another version, none at all. */
export async function log_files(browser, url) {
  const {page, done} = await blank(browser), dialog = page.locator('.recordings-dialog');
  await page.goto(`${url}#robot=nottingham-tpcj&screen=operate`);
  await until(page, () => !!window.__sinew?.operate?.frame);
  const refused = async (content, says, file = 'mine.csv') => {
    await drop(page, file, content);
    await dialog.filter({hasText: says}).waitFor();
    assert.ok(!await page.evaluate(() => window.__sinew.operate.replayed), String(says));
    const said = await dialog.innerText();
    await dialog.getByRole('button', {name: 'Close'}).click();
    return said;
  };
  const change = (index, to) => lines.map((line, i) => (i === index ? to(line) : line)).join('\n');
  assert.match(await refused('', 'mine.csv, line 1'), /found “”; a recording begins with “# sinew recording, version 1”: choose a file/);
  await refused('time,value\n1,2\n', 'found “time,value”');
  await refused('\x00\x01\x02<img src=x onerror=alert(1)>', '<img src=x');
  await refused(text.replace('version 1', 'version 2'), 'line 1: found version 2');
  await refused(lines.slice(0, first).join('\n'), 'found no row of measurements');
  await refused(change(first - 1, (line) => line.replace('S1_change_2', 'S1_chang_2')), 'column S1_change_2 is missing');
  await refused(lines.filter((line) => !line.startsWith('#   ')).join('\n'), 'found no robot');
  await refused(text.replace('#   kind: serial', '#   kind: sirial'), /# file:/);
  await shot(page, 'log-refused');
  await refused(text.replace('count: 5, type', 'count: 4, type'), 'it has 5 sections, the robot in it 4');
  // rows that are wrong are left out, and said
  const rows = [...lines];
  rows[first + 3] = rows[first + 3].split(',').slice(0, 20).join(',');
  rows[first + 6] = rows[first + 6].replace(/^[\d.]+/, 'soon');
  rows[first + 9] = rows[first + 9].replace(/^[\d.]+/, '0.001');
  rows[first + 12] = rows[first + 12].replace('EXACT', 'FINE');
  const last = rows.length - 2;
  rows.splice(last, 2, rows[last].slice(0, 200));
  await drop(page, 'mine.csv', rows.join('\r\n'));
  await until(page, () => window.__sinew.operate.replayed?.leftOut === 5 && !!window.__sinew.operate.frame);
  await page.locator('#op-notice', {hasText: '5 lines were left out'}).waitFor();
  assert.match(await page.locator('#op-tip').innerText(), /left out\s*5/);
  const wrong = await page.evaluate(() => window.__sinew.operate.replayed.wrong);
  assert.match(wrong[0], new RegExp(`^line ${first + 4}: found 20 fields, not \\d+$`));
  assert.match(wrong[1], /time “soon”, no number/);
  assert.match(wrong[2], /time 0\.001 after/);
  assert.match(wrong[3], /state “FINE”/);
  assert.match(wrong[4], /is cut off .*: the recording ends there/);
  await page.keyboard.press('l');
  await page.locator('.drawer', {hasText: 'copy the file anew'}).waitFor();
  await shot(page, 'log-damaged');
  await page.keyboard.press('l');
  assert.ok(!/recording=/.test(await linked(page)), 'no link shows a file of this computer');
  // whose it is
  await drop(page, 'other.csv', text.replace('tolerance: 0.05 mm', 'tolerance: 0.04 mm'));
  await page.locator('#op-notice', {hasText: 'with another file of nottingham-tpcj than the one that is open'}).waitFor();
  await done(/422/);
}

/** The recording without its measurements of a while. */
const without = (from, to) => lines.filter((line, i) => i < first || !(Number(line.split(',')[0]) > from && Number(line.split(',')[0]) < to) || line.endsWith('"')).join('\n');

/** Curves are broken where measurements are missing, and nowhere else: nobody knows what was there. */
export async function log_gap(browser) {
  const {page, done} = await replay(browser);
  const drawnGaps = () => page.evaluate(() => window.__sinew.way.curves.panels.map(({plot}) => plot.data.slice(1).map((line) => line.filter((value) => value === null).length)));
  const reported = async () => {
    const saved = page.waitForEvent('download');
    await bar(page, 'Report').click();
    const html = readFileSync(await (await saved).path(), 'utf8');
    return [...html.matchAll(/class="curve[^"]*" d="([^"]*)"/g)].map(([, d]) => d.split('M').length - 2);
  };
  const all = (found, count) => assert.deepEqual([...new Set(found.flat(2))], [count], JSON.stringify(found));
  for (const [file, content, count] of [['whole.csv', text, 0], ['gap.csv', without(2, 2.8), 1], ['gaps.csv', text.split('\n').filter((line) => without(2, 2.8).includes(line) && without(4.1, 4.9).includes(line)).join('\n'), 2]]) {
    await drop(page, file, content);
    await until(page, (name) => window.__sinew.operate.badge?.startsWith(`LOG ${name}`), file.split('.')[0]);
    all(await reported(), count);
    await bar(page, 'Trajectory').click();
    await until(page, () => document.querySelectorAll('.curve canvas').length === 3);
    all(await drawnGaps(), count);
    if (count > 0) await shot(page, `log-${file.split('.')[0]}`);
    await page.keyboard.press('Alt+2');
    await bar(page, 'Close').waitFor();
  }
  await done();
}

/** On the screen Trajectory: what was measured over time, without a scene, unchecked, and not to be driven. */
export async function log_way(browser) {
  const {page, done} = await replay(browser, '&t=3'), step = async () => Number(await page.locator('#transport input').inputValue());
  const way = (of, is) => until(of, is ?? (() => document.documentElement.dataset.drawn !== undefined && Number(document.documentElement.dataset.drawn) === window.__sinew.way.step));
  await at(page, 3);
  await bar(page, 'Trajectory').click();
  await way(page);
  const {rows, times} = await page.evaluate(() => ({rows: window.__sinew.operate.replayed.rows, times: [...window.__sinew.operate.replayed.times]}));
  assert.ok(Math.abs(times[await step()] - 3) < 0.1, 'where the replay was');
  assert.match(await page.locator('#source').innerText(), /^LOG nottingham-tpcj$/);
  assert.match(await page.locator('#plan-verdict').innerText(), /RECORDED[^]*What it touched is not known/);
  assert.match(await page.locator('#plan-checks').innerText(), /^At 3\.0\d s\s+stage\s+12\.\d+ mm\s+tip x, y, z/);
  assert.deepEqual(await page.locator('.curve .about button').allInnerTexts(), ['joint angles', 'stage', 'tendon changes']);
  const said = await page.locator('.curve .value').allInnerTexts(), row = await step();
  const changes = await page.evaluate((k) => [0, 1, 2, 3, 4].flatMap((m) => window.__sinew.operate.replayed.ofTendons(k, m, 'change')), row), most = changes.reduce((a, b) => (Math.abs(b) > Math.abs(a) ? b : a));
  assert.ok(said[2].includes(Math.abs(1e3 * most).toFixed(1)), `${said[2]}: measured, not computed: ${most}`);
  await page.getByRole('button', {name: 'Drive…'}).click({force: true});
  await page.locator('#toast', {hasText: 'a recording is no plan'}).waitFor();
  await page.keyboard.press('.');
  assert.equal(await step(), row + 1);
  // dragging in a curve is in time
  const plot = await page.locator('.curve .plot').first().boundingBox();
  await page.mouse.click(plot.x + 48 + 0.5 * (plot.width - 60), plot.y + 20);
  const half = (times[0] + times.at(-1)) / 2;
  assert.ok(Math.abs(times[await step()] - half) < 0.1);
  await way(page);
  const address = await linked(page);
  assert.match(address, /screen=trajectory&recording=nottingham-tpcj&step=\d+/);
  // played at the pace of the recording, to its end
  for (let i = 0; i < 3; ++i) await page.keyboard.press('l');
  await page.locator('#transport').getByRole('button', {name: /Play/}).click();
  await until(page, (last) => Number(document.querySelector('#transport input').value) === last, rows - 1);
  await page.keyboard.press('Alt+2');
  await bar(page, 'Close').waitFor();
  await done();
  for (const [width, height] of sizes) {
    const again = await blank(browser, {width, height});
    await again.page.goto(address);
    await way(again.page);
    assert.match(await again.page.locator('#transport').innerText(), /\d\.\d\d \/ 6\.\d\d s/);
    for (const theme of themes) {
      await again.page.emulateMedia({colorScheme: theme});
      await drawn(again.page);
      await shot(again.page, `log-way-${width}-${theme}`);
    }
    await audit(again.page, `way ${width}`);
    await again.done();
  }
  const unset = await replay(browser);
  await drop(unset.page, 'unset.csv', text.replaceAll(/,1,((?:[A-Z -]+,){5})/g, ',0,$1'));
  await until(unset.page, () => window.__sinew.operate.badge.startsWith('LOG unset'));
  await bar(unset.page, 'Trajectory').click();
  await unset.page.locator('#op-notice', {hasText: 'its zeros were not set'}).waitFor();
  await unset.done();
}

/** One page with all of it, in which a text is a text. */
export async function log_report(browser) {
  const {page, done} = await replay(browser, '&t=1'), evil = '<script>alert(1)</script><img src=x onerror=alert(2)>"&';
  const reported = async (file) => {
    const saved = page.waitForEvent('download');
    await bar(page, 'Report').click();
    const path = await (await saved).path(), html = readFileSync(path, 'utf8');
    writeFileSync(join(folder, file), html);
    assert.doesNotMatch(html, /<script|<link|https?:\/\/(?!www\.w3\.org)/i);
    return html;
  };
  const html = await reported('log-report.html');
  for (const part of ['Time in each state', 'S2 OVER-TENSIONED', 'Bends of S5', 'Stage [mm]', 'Tensions of S3', 'data:image/png;base64', 'at the "first" target', 'table FAA74276', 'disarmed: over-tension', 'type: tpcj']) assert.ok(html.includes(part), part);
  assert.equal((html.match(/class="diagram/g) ?? []).length, await page.evaluate(() => window.__sinew.operate.replayed.alarms.filter(({word}) => word !== 'NO DATA').length));
  await drop(page, 'evil.csv', text.replace('# robot: nottingham-tpcj', `# robot: ${evil}`).replace('"moving"', `"${evil.replaceAll('"', '""')}"`).replace('#   sinew: 1', `#   sinew: 1  # </pre>${evil}`));
  await until(page, () => window.__sinew.operate.replayed?.robot.startsWith('<script>'));
  await reported('log-report-evil.html');
  await done();
  const paper = await browser.newContext({viewport: {width: 1000, height: 900}}), sheet = await paper.newPage();
  sheet.on('dialog', () => assert.fail('a text was a script'));
  for (const file of ['log-report', 'log-report-evil']) {
    await sheet.goto(pathToFileURL(join(folder, `${file}.html`)).href);
    assert.equal(await sheet.locator('script').count(), 0);
    assert.equal(await sheet.locator('img').count(), file === 'log-report' ? 1 : 0, 'pictures are those of the recording');
    await sheet.screenshot({path: join(folder, `${file}.png`), fullPage: true});
  }
  assert.match(await sheet.locator('table').last().innerText(), /<script>alert\(1\)<\/script><img/);
  await sheet.emulateMedia({media: 'print'});
  await sheet.goto(pathToFileURL(join(folder, 'log-report.html')).href);
  assert.ok(await sheet.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  await sheet.pdf({path: join(folder, 'log-report.pdf')}).catch(() => undefined);
  await paper.close();
}

/** Beside a device: Hold is there, and whoever controls it opens no recording. Pictures of the camera are kept where it records. */
export async function log_device(browser, url) {
  const own = readFileSync(new URL('../../robots/nottingham-tpcj.yaml', import.meta.url), 'utf8'), stand = await standIn(url, 'nottingham-tpcj.yaml', own), make = await framer(url, own);
  stand.push(await make(Array(5).fill([0.05, 0.02])));
  const telling = setInterval(() => stand.push(stand.frame), 50), {page, done} = await blank(browser, {locale: 'en'});
  await page.addInitScript(() => {
    navigator.mediaDevices.enumerateDevices = () => Promise.resolve([{kind: 'videoinput'}]);
    navigator.mediaDevices.getUserMedia = () => {
      const canvas = Object.assign(document.createElement('canvas'), {width: 320, height: 240}), context = canvas.getContext('2d');
      setInterval(() => context.fillRect(0, 0, 320, 240), 50);
      return Promise.resolve(canvas.captureStream());
    };
  });
  const arrived = async (is) => { for (let tries = 0; !is(); ++tries) { assert.ok(tries < 600, `it was not said: ${is}`); await new Promise((next) => setTimeout(next, 20)); } };
  await page.goto(stand.url);
  await until(page, () => !!window.__sinew?.operate?.frame);
  await page.getByRole('button', {name: 'Show the camera'}).click();
  const snapshot = page.getByRole('button', {name: /Snapshot/});
  await snapshot.waitFor();
  const saved = page.waitForEvent('download');
  await snapshot.click();
  assert.match((await saved).suggestedFilename(), /^snapshot-.*\.png$/, 'where nothing records it is saved here');
  assert.equal(stand.calls('snapshot').length, 0, 'and sent nowhere');
  stand.push({...stand.frame, recording: {name: 'now', rows: 5, error: ''}});
  await until(page, () => window.__sinew.operate.frame.recording?.rows === 5);
  await page.getByLabel('words to a snapshot').fill('at the blade & beyond');
  await snapshot.click();
  await arrived(() => stand.calls('snapshot').length === 1);
  const {body} = stand.calls('snapshot')[0];
  assert.deepEqual([body.text, body.type], ['at the blade & beyond', 'image/jpeg']);
  assert.ok(body.bytes > 500);
  await page.locator('#toast', {hasText: 'recorded-001.jpg is kept'}).waitFor();
  await shot(page, 'log-snapshot');
  stand.refusals.snapshot = {code: 'too_many', message: 'pictures before it are not written yet'};
  const instead = page.waitForEvent('download');
  await snapshot.click();
  await instead;
  await page.locator('#op-notice', {hasText: 'not written yet'}).waitFor();
  // whoever controls it looks at nothing else
  await bar(page, /Take control/).click();
  await bar(page, /Arm…/).waitFor();
  await drop(page, 'mine.csv', text);
  await page.locator('.recordings-dialog', {hasText: 'this page controls the device'}).waitFor();
  await page.locator('.recordings-dialog').getByRole('button', {name: 'Close'}).click();
  await bar(page, /Release/).click();
  await bar(page, /Take control/).waitFor();
  await drop(page, 'mine.csv', text);
  await until(page, () => !!window.__sinew.operate.replayed && !!window.__sinew.operate.frame);
  await page.locator('#op-notice', {hasText: 'another robot than the device'}).waitFor();  // its file has the motor
  await shot(page, 'log-beside-device');
  const holds = stand.calls('hold').length;
  await bar(page, 'HOLD').click();
  await arrived(() => stand.calls('hold').length === holds + 1);
  await page.locator('#op-view').focus();
  await page.keyboard.press('Escape');
  await arrived(() => stand.calls('hold').length === holds + 2);
  await page.keyboard.press(' ');
  await bar(page, /Pause/).waitFor();
  assert.equal(stand.calls('hold').length, holds + 2, 'Space plays');
  await bar(page, 'Close').click();
  await bar(page, /Take control/).waitFor();
  clearInterval(telling);
  await done(/409|ERR_/);
  stand.close();
}
