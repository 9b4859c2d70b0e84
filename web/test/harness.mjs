// What the tests of the page share: a server, a browser in which nothing may go wrong, and waiting.
import axe from 'axe-core';
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {mkdirSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {createInterface} from 'node:readline';
import {chromium} from 'playwright-core';

export const [, , sinew, executablePath, folder] = process.argv;
mkdirSync(folder, {recursive: true});

/** All that may be combined is, and what is measured is measured for long. */
export const isThorough = process.env.SINEW_TEST_THOROUGH === '1';

// Node keeps a connection for its next request. On a busy machine it sends that one just as the server closes the connection, idle for 5 s,
// and unlike a browser it does not try again. So every request has a connection of its own.
const onKeptConnection = globalThis.fetch;
globalThis.fetch = (url, options = {}) => onKeptConnection(url, {...options, headers: {...options.headers, Connection: 'close'}});

const patience = 120e3;  // ms; on a busy machine even a page takes half a minute to load, and only what never comes is wrong

export async function serve(...options) {
  const all = ['serve', ...(options.includes('--port') ? options : [...options, '--port', '0']), '-q'];
  const server = spawn(sinew, all, {stdio: ['ignore', 'pipe', 'inherit']});
  process.once('exit', () => server.kill('SIGKILL'));  // whatever ended this: left alone, it would hold the test's output open
  const url = await new Promise((resolve) => createInterface(server.stdout).once('line', resolve));
  return {server, url};
}

const plain = new WeakSet();  // browsers without WebGL

/** @param hasWebGL by software, as Chromium of a machine without a screen has nothing else */
export async function launch({hasWebGL = true} = {}) {
  const drawing = hasWebGL ? ['--enable-unsafe-swiftshader'] : ['--disable-gpu', '--disable-software-rasterizer', '--disable-webgl'];
  const browser = await chromium.launch({
    executablePath,
    // Of a tile that has changed in part Chromium draws that part alone, and pixels at its edge get other shades: once in a hundred times the
    // same picture was another one. Pictures are compared, so tiles are drawn whole.
    args: ['--no-sandbox', '--disable-partial-raster', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update',
           '--disable-sync', ...drawing],
  });
  if (!hasWebGL) plain.add(browser);
  return browser;
}

const spare = new WeakMap();  // by browser: pages whose case is done

/** Opening a window costs Chromium more than all else that most cases do: a page that is done goes on as the next one's. */
async function lend(browser, {width, height, theme, reducedMotion = null, isOwn, ...more}) {
  const page = (isOwn ? null : spare.get(browser)?.pop()) ?? await (await browser.newContext({permissions: ['clipboard-read', 'clipboard-write'], ...more})).newPage();
  page.setDefaultTimeout(patience);
  await page.setViewportSize({width, height});
  await page.emulateMedia({media: null, colorScheme: theme, reducedMotion});
  return page;
}

/** Nothing of what was done with it may be found by the next case. */
async function takeBack(browser, page) {
  page.removeAllListeners();
  await page.unrouteAll({behavior: 'ignoreErrors'});
  await page.evaluate(() => { localStorage.clear(); sessionStorage.clear(); });
  await page.context().clearCookies();
  await page.goto(new URL('/api/version', page.url()).href);  // of the same site, so Chromium keeps the process
  await page.mouse.move(0, 0);
  spare.set(browser, [...(spare.get(browser) ?? []), page]);
}

/**
 * A page on which nothing may go wrong: no error on its console, no request to anyone else. `done` says so and gives it back.
 * @param options isOwn: a new one, for cases that leave something in it; so has one with options of Playwright's
 */
export async function blank(browser, {width = 1280, height = 800, theme = 'light', reducedMotion, ...more} = {}) {
  const isOwn = Object.keys(more).length > 0, page = await lend(browser, {...more, width, height, theme, reducedMotion, isOwn}), wrong = [];
  page.on('console', (line) => {
    const {url} = line.location(), path = URL.canParse(url) ? new URL(url).pathname : '';
    // an icon is asked for by the browser, for the bare answer that a lent page rests on; the page has its own
    const isExpected = path === '/favicon.ico' || (plain.has(browser) && /WebGL/i.test(line.text()));
    if (line.type() === 'error' && !isExpected) wrong.push(`${line.text()} ${path}`);
  });
  page.on('pageerror', (error) => wrong.push(error.stack));
  page.on('request', (request) => {
    const {protocol, hostname} = new URL(request.url());
    if (hostname !== '127.0.0.1' && !['data:', 'blob:'].includes(protocol)) wrong.push(`foreign: ${request.url()}`);
  });
  /** @param allowed errors that belong to the case, which browsers report by themselves */
  const done = async (allowed = /^$/) => {
    await fits(page);
    assert.deepEqual(wrong.filter((line) => !allowed.test(line)), []);
    await (isOwn ? page.context().close() : takeBack(browser, page));
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

const sessions = new WeakMap();

/** Playwright's own screenshots take three times as long: they wait for fonts, hide carets and pack more than a comparison needs. */
async function capture(page, clip) {
  if (!sessions.has(page)) sessions.set(page, page.context().newCDPSession(page));
  const {data} = await (await sessions.get(page)).send('Page.captureScreenshot', {format: 'png', optimizeForSpeed: true, ...(clip && {clip: {...clip, scale: 1}})});
  return Buffer.from(data, 'base64');
}

export const picture = async (page) => capture(page, await page.evaluate(() => {
  const {left, top, width, height} = document.getElementById('view').getBoundingClientRect();
  return {x: Math.floor(left), y: Math.floor(top), width: Math.ceil(width), height: Math.ceil(height)};
}));
export const shot = async (page, name) => writeFileSync(join(folder, `${name}.png`), await capture(page));

/** What is seen now, as large as a desk and as a phone, by day and in the dark; then as it was. */
export async function looks(page, name) {
  const size = page.viewportSize(), theme = await page.evaluate(() => (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light'));
  for (const [width, height] of [[1280, 800], [390, 844]]) {
    await page.setViewportSize({width, height});
    for (const colorScheme of ['light', 'dark']) {
      await page.emulateMedia({colorScheme});
      await drawn(page);
      await shot(page, `${name}-${width}-${colorScheme}`);
      await fits(page);
    }
  }
  await page.setViewportSize(size);
  await page.emulateMedia({colorScheme: theme});
  await drawn(page);
}

/** Of screenshots: unlike them assert.deepEqual would print every byte. */
export const differs = (a, b, what = '') => assert.ok(!a.equals(b), `${what}: the picture did not change`);
export const same = (a, b, what = '') => assert.ok(a.equals(b), `${what}: another picture`);

/**
 * Waits for what the page says of itself, two pictures long. It is the page that looks: asking it time and again keeps it from its work.
 * @param after how many answers; null: it is at rest
 */
const told = (page, after) => page.evaluate(([count, longest]) => new Promise((done) => {
  const root = document.documentElement, is = () => (count === null ? root.dataset.rests === root.dataset.answers : Number(root.dataset.answers ?? 0) > count);
  const watch = new MutationObserver(() => is() && end(true)), late = setTimeout(() => end(false), longest);
  const end = (was) => {
    watch.disconnect();
    clearTimeout(late);
    requestAnimationFrame(() => requestAnimationFrame(() => done(was)));
  };
  if (is()) end(true);
  else watch.observe(root, {attributes: true});
}), [after, patience]);

/** Waits for the picture of an answer after so many. */
export const settled = async (page, after) => assert.ok(await told(page, after), 'no answer came');

/** Waits for what is asked when nothing moves. */
export const rested = async (page) => assert.ok(await told(page, null), 'it came not to rest');

/** Waits for the picture of what was done, where nothing is asked for it. */
export const drawn = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done()))));

/** The address, which the page writes 200 ms after it has changed: its timers end in the order of their times. */
export const linked = (page) => page.evaluate(() => new Promise((done) => setTimeout(() => done(location.href), 250)));

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
  const beyond = await page.evaluate(() => {
    const below = (one) => one.getBoundingClientRect().bottom - innerHeight;  // of what is cut off there, as nothing scrolls
    return [document.documentElement.scrollWidth - innerWidth, document.documentElement.scrollHeight - innerHeight, ...[...document.querySelectorAll('#op-bar :is(button, code, output)')].map(below)];
  });
  assert.ok(Math.max(...beyond) <= 0, 'the page is larger than the window');
}

export const fill = async (page, id, text) => {
  await page.locator(`#${id}`).fill(text);
  await page.locator(`#${id}`).press('Enter');
};

export const tab = (page, name) => page.getByRole('tab', {name}).click();

/** The rules of axe. */
export async function audit(page, what) {
  if (!await page.evaluate(() => 'axe' in window)) await page.evaluate(axe.source);
  const {violations} = await page.evaluate(() => window.axe.run(document, {resultTypes: ['violations'], runOnly: ['wcag2a', 'wcag2aa', 'wcag21aa', 'best-practice'], rules: {'page-has-heading-one': {enabled: false}}}));
  assert.deepEqual(violations.map(({id, nodes}) => `${what}: ${id}: ${nodes.map((node) => node.target.join(' ')).slice(0, 4).join(', ')}`), []);
}
