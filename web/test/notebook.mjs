// The page in a frame of a notebook: a page of another origin, with the HTML that Python's `robot.view()` writes into it.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {answers, blank, rested, serve, settled, shot, then} from './harness.mjs';

const source = readFileSync(new URL('../../python/sinew/_view.py', import.meta.url), 'utf8');
const written = /return f'(<iframe src="\{self\.url\}".*<\/iframe>)'/.exec(source)?.[1];
assert.ok(written, 'the frame of View._repr_html_ is not found');
const notebookOf = (url) => `<!doctype html><html lang="en"><title>notebook</title><link rel="icon" href="data:,"><p>In [1]: robot.view()</p>${written.replace('{self.url}', url)}`;

/** A page that has the frame, from an origin of its own. */
async function notebook(url) {
  const server = createServer((_, answer) => answer.writeHead(200, {'Content-Type': 'text/html; charset=utf-8', Connection: 'close'}).end(notebookOf(url)));
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  return {server, address: `http://127.0.0.1:${server.address().port}/`};
}

/** The frame once its document has come, whatever that is: Chromium puts one of its own in place of what it refuses. */
async function frameOf(page, address) {
  await page.goto(address);
  const [, frame] = page.frames();
  assert.ok(frame, 'the notebook has no frame');
  await frame.waitForLoadState('load');
  return frame;
}
const isThere = (frame) => frame.locator('#view').count().catch(() => 0);

/** It draws, answers, and draws what was answered. */
export async function notebook_frame(browser) {
  const {server, url} = await serve('3-rfr', '--frame'), {server: pages, address} = await notebook(url);
  const {page, done} = await blank(browser, {locale: 'en-GB'});
  try {
    assert.notEqual(new URL(address).origin, new URL(url).origin);
    const frame = await frameOf(page, address);
    await settled(frame, 0);
    await rested(frame);
    assert.match(await frame.locator('#verdict strong').textContent(), /SOLVED/);
    const picture = () => frame.locator('#view').screenshot(), numbers = () => frame.locator('#numbers').textContent();
    const before = await picture(), said = await numbers(), count = await answers(frame);
    await then(frame, () => frame.locator('#inputs input[type=range]').first().press('ArrowRight'));
    await rested(frame);
    assert.ok(await answers(frame) > count);
    assert.notEqual(await numbers(), said);
    assert.ok(!before.equals(await picture()), 'the picture did not change');
    await shot(page, 'notebook-frame');
  } finally {
    pages.close();
    server.kill('SIGINT');
  }
  await done();
}

/** Who did not ask for it has no frame, and no page of another machine has one. */
export async function foreign_frames(browser) {
  for (const [options, site] of [[[], null], [['--frame'], 'http://notebook.example/']]) {
    const {server, url} = await serve('3-rfr', ...options), {server: pages, address} = await notebook(url);
    const {page, done} = await blank(browser, {locale: 'en-GB'});
    try {
      if (site) await page.route(site, (route) => route.fulfill({contentType: 'text/html; charset=utf-8', body: notebookOf(url)}));
      assert.equal(await isThere(await frameOf(page, site ?? address)), 0, `${options} ${site}: the page is in a frame`);
      const headers = (await fetch(url)).headers, policy = headers.get('Content-Security-Policy');
      assert.match(policy, options.length ? /frame-ancestors http:\/\/127\.0\.0\.1:\* http:\/\/localhost:\*;/ : /frame-ancestors 'none';/);
    } finally {
      pages.close();
      server.kill('SIGINT');
    }
    await done(/frame-ancestors|Refused to frame|Framing|foreign: http:\/\/notebook\.example/);
  }
}
