// What goes wrong, and what is seen then (the table of errors).
import assert from 'node:assert/strict';
import {copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {answers, blank, differs, hold, launch, looks, numbers, open, picture, rested, serve, settled, tab, then, verdict} from './harness.mjs';

/** A server that goes away and comes back, with none of its robots. */
export async function connection(browser) {
  const first = await serve(), {page, done} = await open(browser, first.url, '3-rfr'), before = await numbers(page);
  const gone = new Promise((ended) => first.server.once('exit', ended));
  first.server.kill('SIGINT');
  await gone;
  await page.locator('#inputs input[type=range]').first().press('ArrowRight');
  await page.locator('#lost', {hasText: /NO CONNECTION \d+ s/}).waitFor();
  assert.ok(await page.evaluate(() => document.body.classList.contains('lost')));
  assert.equal(await numbers(page), before, 'the last answer stays');
  await page.locator('#answer.stale').waitFor();
  await looks(page, 'no-connection');
  const count = await answers(page), second = await serve('--port', new URL(first.url).port);
  await settled(page, count);
  assert.match(await verdict(page), /SOLVED/);
  assert.match(await page.locator('#status').innerText(), /converged/);
  await done(/ERR_|404/);
  second.server.kill('SIGINT');
}

/** An answer that takes long: a ring, then words and a way out; sliders stay live, only the newest question is kept. */
export async function slow(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr'), held = await hold(page);
  const slider = page.locator('#inputs input[type=range]').first(), count = await answers(page);
  for (let i = 0; i < 5; ++i) await slider.press('ArrowRight');
  await page.locator('#verdict.waiting').waitFor();
  await page.locator('#verdict', {hasText: 'solving…'}).waitFor();
  await looks(page, 'slow');
  await held.next();
  await settled(page, count);
  await held.arrival(2);
  assert.equal(held.asked.filter((text) => /"forward"/.test(text)).length, 2, 'of five questions the first and the newest are asked');
  await held.next();
  await settled(page, count + 1);
  await slider.press('ArrowRight');
  await page.locator('#verdict').getByRole('button', {name: 'Cancel'}).click();
  assert.equal(await page.locator('#status').innerText(), 'cancelled');
  await page.unroute('**/api/query*');
  await then(page, () => slider.press('ArrowRight'));
  await done();
}

/** Bad numbers go to the place where they are; a bad link to the start. */
export async function links_that_lead_nowhere(browser, url) {
  const {page, done} = await blank(browser);
  await page.goto(`${url}#robot=nobody`);
  await page.locator('.robot').first().waitFor();
  assert.match(await page.locator('#status').innerText(), /nobody: open its file/);
  await then(page, () => page.goto(`${url}#robot=3-rfr&inputs=1,2&load=x&model=y&camera=zzz&layers=q&bending=7`));
  assert.match(await verdict(page), /SOLVED/);
  await done();
}

/** A program of another protocol. */
export async function another_version(browser, url) {
  const {page, done} = await blank(browser);
  await page.route('**/api/version', (route) => route.fulfill({json: {sinew: '9.0.0', protocol: 2}}));
  await page.goto(url);
  await page.locator('#status', {hasText: 'page and program differ (protocol 1, 2): reload'}).waitFor();
  await page.locator('.plate', {hasText: 'page and program differ'}).getByRole('button', {name: 'Reload'}).waitFor();
  await looks(page, 'another-version');
  await done();
}

/** The file of the command line changes on disk. */
export async function disk(browser) {
  const folder = mkdtempSync(join(tmpdir(), 'sinew-')), path = join(folder, 'mine.yaml'), robots = new URL('../../robots/', import.meta.url);
  copyFileSync(new URL('3-frr.yaml', robots), path);
  const {server, url} = await serve(path), {page, done} = await blank(browser);
  await page.goto(url);
  await settled(page, 0);
  await rested(page);
  assert.match(await page.locator('#command').innerText(), new RegExp(`^sinew forward ${path} `));
  await tab(page, 'File');
  const before = await numbers(page), text = readFileSync(path, 'utf8'), other = text.replaceAll('radius: 50 mm', 'radius: 61 mm');
  assert.notEqual(other, text);
  writeFileSync(path, other);
  await page.evaluate(() => window.dispatchEvent(new Event('focus')));
  await page.locator('#file .disk').waitFor();
  await looks(page, 'changed-on-disk');
  await then(page, () => page.locator('#file .disk').getByRole('button', {name: 'Reload'}).click());
  assert.notEqual(await numbers(page), before);
  writeFileSync(path, text);
  await page.evaluate(() => window.dispatchEvent(new Event('focus')));
  await page.locator('#file .disk').getByRole('button', {name: 'Keep mine'}).click();
  await page.locator('#file .disk').waitFor({state: 'hidden'});
  await page.locator('#robot option:checked', {hasText: 'mine.yaml (modified)'}).waitFor({state: 'attached'});  // no longer what the file says
  assert.match(await page.locator('#command').innerText(), /--set "platform\.radius=61 mm"/);
  await rested(page);
  await done();
  server.kill('SIGINT');
  rmSync(folder, {recursive: true});
}

/** The robot that --set changes is shown, its commands and links say so, and its file can be taken as it is. */
export async function changed(browser) {
  const {server, url} = await serve('3-rfr', '--set', 'legs[0].link.length=180 mm'), {page, done} = await blank(browser);
  await page.goto(url);
  await settled(page, 0);
  await rested(page);
  await page.locator('#robot option:checked', {hasText: '(modified)'}).waitFor({state: 'attached'});
  const command = () => page.locator('#command').innerText();
  assert.match(await command(), /^sinew forward 3-rfr .*--set "legs\[0\]\.link\.length=180 mm"/);
  const shown = await numbers(page);
  await page.reload();
  await settled(page, 0);
  await rested(page);
  assert.equal(await numbers(page), shown, 'the link leads to the same robot');
  await tab(page, 'File');
  await then(page, () => page.locator('#file').getByRole('button', {name: 'Reload'}).click());
  assert.doesNotMatch(await command(), /--set/);
  await done();
  server.kill('SIGINT');
}

/** No WebGL: the same picture by simpler means, and a word about it. */
export async function no_webgl(_, url) {
  const browser = await launch({hasWebGL: false}), {page, done} = await open(browser, url, '3pfs-g2');
  assert.match(await page.locator('#view').innerText(), /no WebGL/);
  const before = await picture(page);
  await then(page, () => page.locator('#inputs input[type=range]').first().press('Shift+ArrowRight'));
  differs(await picture(page), before);
  await looks(page, 'no-webgl');
  await done();
  await browser.close();
}

/** Of another address only who has the token is answered; others read where it is. */
export async function token(browser) {
  const {server, url} = await serve('--host', '0.0.0.0'), {page, done} = await blank(browser), here = new URL(url);
  here.hostname = '127.0.0.1';
  await page.goto(here.origin);
  assert.match(await page.locator('body').innerText(), /^open the address printed by sinew serve/);
  await looks(page, 'token');
  await page.goto(`${here.href}#robot=3-rfr`);
  await settled(page, 0);
  assert.match(await verdict(page), /SOLVED/);
  assert.doesNotMatch(page.url(), /token/);
  await done(/403/);
  server.kill('SIGINT');
}
