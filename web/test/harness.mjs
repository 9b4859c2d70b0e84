// What the tests of the page share: a server, a browser in which nothing may go wrong, and waiting.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {mkdirSync} from 'node:fs';
import {join} from 'node:path';
import {createInterface} from 'node:readline';
import {chromium} from 'playwright-core';

export const [, , sinew, executablePath, folder] = process.argv;
mkdirSync(folder, {recursive: true});

export async function serve(...options) {
  const all = ['serve', ...(options.includes('--port') ? options : [...options, '--port', '0']), '-q'];
  const server = spawn(sinew, all, {stdio: ['ignore', 'pipe', 'inherit']});
  const url = await new Promise((resolve) => createInterface(server.stdout).once('line', resolve));
  return {server, url};
}

export const launch = (...more) => chromium.launch({
  executablePath,
  args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update',
         '--disable-sync', '--enable-unsafe-swiftshader', ...more],
});

/** A page on which nothing may go wrong: no error on its console, no request to anyone else. `done` says so and closes it. */
export async function blank(browser, {width = 1280, height = 800, theme = 'light', ...more} = {}) {
  const context = await browser.newContext({viewport: {width, height}, colorScheme: theme, permissions: ['clipboard-read', 'clipboard-write'], ...more});
  const page = await context.newPage(), wrong = [];
  page.on('console', (line) => line.type() === 'error' && wrong.push(line.text()));
  page.on('pageerror', (error) => wrong.push(error.stack));
  page.on('request', (request) => {
    const {protocol, hostname} = new URL(request.url());
    if (hostname !== '127.0.0.1' && !['data:', 'blob:'].includes(protocol)) wrong.push(`foreign: ${request.url()}`);
  });
  /** @param allowed errors that belong to the case, which browsers report by themselves */
  const done = async (allowed = /^$/) => {
    await fits(page);
    assert.deepEqual(wrong.filter((line) => !allowed.test(line)), []);
    await context.close();
  };
  return {page, done};
}

/** The same with a robot in it, at rest. */
export async function open(browser, url, robot, options) {
  const opened = await blank(browser, options);
  await opened.page.goto(`${url}#robot=${robot}`);
  await settled(opened.page, 0);
  await rested(opened.page);
  return opened;
}

export const answers = (page) => page.evaluate(() => Number(document.documentElement.dataset.answers ?? 0));
export const numbers = (page) => page.locator('#numbers').innerText();
export const answer = (page) => page.locator('#right').innerText();
export const verdict = (page) => page.locator('#verdict strong').innerText();
export const picture = (page) => page.locator('#view').screenshot();
export const shot = (page, name) => page.screenshot({path: join(folder, `${name}.png`)});

/** Of screenshots: unlike them assert.deepEqual would print every byte. */
export const differs = (a, b, what = '') => assert.ok(!a.equals(b), `${what}: the picture did not change`);
export const same = (a, b, what = '') => assert.ok(a.equals(b), `${what}: another picture`);

async function until(page, is, what) {
  for (let i = 0; i < 1500; ++i) {
    if (await is()) return;
    await page.waitForTimeout(10);
  }
  assert.fail(what);
}

/** Waits for the picture of an answer after so many. */
export async function settled(page, after) {
  await until(page, async () => (await answers(page)) > after, 'no answer came');
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

/** Waits for what is asked when nothing moves. */
export async function rested(page) {
  await until(page, () => page.evaluate(() => document.documentElement.dataset.rests === document.documentElement.dataset.answers), 'it came not to rest');
}

/** Keeps back requests till they are let go, so that it does not matter how long a busy machine takes for what is done meanwhile. */
export async function hold(page, pattern = '**/api/query*') {
  const asked = [], held = [], go = (route) => route?.continue().catch(() => undefined);  // the page may have cancelled it
  let isHeld = true, arrived = () => undefined;
  await page.route(pattern, (route) => {
    asked.push(route.request().postData());
    arrived();
    if (!isHeld) return go(route);
    held.push(route);
  });
  return {
    asked,
    /** Waits for so many requests in all. */
    arrival: async (count) => { while (asked.length < count) await new Promise((next) => { arrived = next; }); },
    /** Of one, the oldest. */
    next: () => go(held.shift()),
    /** Of all, and of those to come. */
    release: async () => {
      isHeld = false;
      await Promise.all(held.splice(0).map(go));
    },
  };
}

/** Does something and waits for its answer. */
export async function then(page, act) {
  const count = await answers(page);
  await act();
  await settled(page, count);
}

export async function fits(page) {
  const beyond = await page.evaluate(() => [document.documentElement.scrollWidth - innerWidth, document.documentElement.scrollHeight - innerHeight]);
  assert.deepEqual(beyond.map((by) => Math.max(by, 0)), [0, 0], 'the page is larger than the window');
}

export const fill = async (page, id, text) => {
  await page.locator(`#${id}`).fill(text);
  await page.locator(`#${id}`).press('Enter');
};

export const tab = (page, name) => page.getByRole('tab', {name}).click();
