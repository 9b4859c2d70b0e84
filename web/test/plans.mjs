// The screen of a plan: one way into the scene that `sinew new scene` prints, and one that touches it on its way.
import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {audit, blank, differs, drawn, fits, hold, linked, same, shot, sinew} from './harness.mjs';
import {plans} from './ways.mjs';

/** Waits for the picture of a step, or of one at least so far; of any where none is said. */
const at = async (page, step, isFrom = false) => {
  await page.evaluate(([wanted, isAny]) => new Promise((done) => {
    const root = document.documentElement, drawn = () => Number(root.dataset.drawn ?? -1), is = () => (isAny ? drawn() >= wanted : drawn() === wanted), watch = new MutationObserver(() => is() && end());
    const end = () => {
      watch.disconnect();
      done();
    };
    if (is()) end();
    else watch.observe(root, {attributes: true});
  }), [step ?? 0, isFrom || step === undefined]);
  await drawn(page);
};

const verdict = (page) => page.locator('#plan-verdict strong').innerText();
const step = (page) => page.locator('#transport input').inputValue().then(Number);
const heading = (page) => page.locator('#plan-checks h2').last().innerText();

async function see(browser, name, options, more = '') {
  const {url, handles} = await plans(), opened = await blank(browser, options);
  await opened.page.goto(`${url}#plan=${handles[name]}${more}`);
  await at(opened.page);
  return opened;
}

/** Slider, keys and curves go to a step, and all says the same of it; the address brings it back. */
export async function plan_scrubs(browser) {
  const {url, last, handles, file} = await plans(), {page, done} = await blank(browser);
  await page.goto(url);  // without a robot the plan is what there is
  await at(page, last);
  assert.equal(await page.locator('#screens [aria-current=page]').innerText(), 'Trajectory');
  assert.equal(await verdict(page), 'CLEAR ONLY IF TAUT');
  assert.match(await page.locator('#plan-verdict').innerText(), /0\.\d+ mm at step \d+, stage [\d.]+ mm, S\d to \w+/);
  await page.locator('.checked', {hasText: 'tip ends'}).waitFor();  // asks for its shape after the first picture
  assert.match(await page.locator('.checked').innerText(), /all \d+ steps clear[\s\S]*clear with [\d.]+ % of[\s\S]*within their limits[\s\S]*tip ends 0\.\d+ mm from it/);
  const keys = [['.', last], [',', last - 1], ['Shift+Comma', last - 11], ['Shift+Period', last - 1], ['Shift+Comma', last - 11]];
  for (const [key, to] of keys) {
    await page.keyboard.press(key);
    await at(page, to);
    assert.equal(await heading(page), `At step ${to} of ${last}`, key);
  }
  await page.locator('#transport input').fill('40');
  await at(page, 40);
  assert.equal(await page.locator('#transport input').getAttribute('aria-valuetext').then((text) => text.split(',')[0]), `step 40 / ${last}`);
  const plot = await page.locator('.curve .plot').nth(1).boundingBox();
  await page.mouse.move(plot.x + plot.width / 2, plot.y + 20);
  await page.mouse.down();
  await page.mouse.move(plot.x + 48 + 0.75 * (plot.width - 60), plot.y + 30, {steps: 3});
  await page.mouse.up();
  await at(page, Math.round(0.75 * last));
  const cursor = await page.locator('.cursor').boundingBox();
  assert.ok(Math.abs(cursor.x + 1 - (plot.x + 48 + 0.75 * (plot.width - 60))) < 3, 'the cursor is elsewhere');
  const before = await step(page), spots = await page.locator('.spots button').evaluateAll((all) => all.map(({dataset}) => Number(dataset.step))), after = Math.min(...spots.filter((one) => one > before));
  assert.ok(spots.length >= 3);
  await page.keyboard.press('n');
  await at(page, Number.isFinite(after) ? after : Math.min(...spots));
  await page.locator('.spots button').first().click();
  await at(page, spots[0]);
  assert.equal(await page.locator('.spots [aria-current=true]').count(), 1);
  await page.keyboard.press('e');
  await page.locator('#toast', {hasText: 'no step fails'}).waitFor();
  await page.locator('#transport input').focus();
  await page.keyboard.press('Home');
  await at(page, 0);
  await page.keyboard.press('l');
  assert.equal(await page.locator('#transport select').inputValue(), '2');
  await page.keyboard.press('Space');
  await at(page, 5, true);
  await page.keyboard.press('Space');
  assert.match(await page.locator('#transport button.main').innerText(), /Play/);
  await page.getByRole('button', {name: 'stage'}).click();
  await page.getByRole('button', {name: 'tendon changes'}).waitFor();
  await page.keyboard.press('u');
  assert.equal(await page.locator('.curve .unit').allInnerTexts().then((all) => all.join(' ')), '[m] [rad] [m]');
  await page.keyboard.press('u');
  await page.locator('#transport input').fill('123');
  await at(page, 123);
  const address = await linked(page), said = await page.locator('#plan-checks .facts').innerText();
  assert.match(address, new RegExp(`#plan=${handles.wall}&step=123&camera=`));
  await page.goto(`${url}api/version`);
  await page.goto(address);
  await at(page, 123);
  await page.locator('#plan-checks .facts', {hasText: 'tendon change'}).waitFor();
  assert.equal(await page.locator('#plan-checks .facts').innerText(), said);
  const command = await page.locator('#command').innerText(), told = spawnSync(sinew, command.split(' ').slice(1), {encoding: 'utf8'}).stdout;
  assert.equal(command, `sinew plan ${file('wall.yaml')} --check ${file('wall.csv')}`);
  assert.match(told, new RegExp(`CLEAR ONLY IF TAUT: ${/^([\d.]+) mm/m.exec(await page.locator('#plan-verdict .detail').innerText())[1]} mm`));
  await page.goto(`${url}?plan=${handles.wall}&step=7`);  // as people may write it
  await at(page, 7);
  await page.keyboard.press('Alt+1');
  await page.locator('.robot').first().waitFor();
  await page.keyboard.press('Alt+4');
  await page.locator('#trajectory').waitFor();
  assert.equal(await step(page), 7);
  await done();
}

/** A plan that touches, one that goes beyond a limit; the key of failed checks goes to both. */
export async function plan_fails(browser) {
  for (const [name, word, first, why] of [['touch', 'TOUCHES', 99, /steps 99 to 119: S\d to \w+/], ['far', 'LIMIT EXCEEDED', 280, /step 280: the stage is at 200\.000 mm, its limits are 0 and 150\.000 mm/]]) {
    const {page, done} = await see(browser, name, {}, '&step=0');
    assert.equal(await verdict(page), word);
    assert.match(await page.locator('#plan-verdict .reason').innerText(), why);
    assert.equal(await page.locator('#plan-verdict').getAttribute('data-state'), 'over');
    assert.ok(await page.locator('.marks .failed').count() > 0);
    await page.keyboard.press('e');
    await at(page, await step(page));
    assert.equal(await step(page), first);
    await page.keyboard.press('.');
    await at(page, first + 1);
    assert.match(await page.locator('#plan-checks .facts').innerText(), name === 'touch' ? /-\d+\.\d+ mm[\s\S]*TOUCHES/ : /limit exceeded/);
    await shot(page, `plan-${name}`);
    await done();
  }
}

/** Plans that are not there, or of another robot, or not checked yet. */
export async function plan_missing(browser, url) {
  const {url: there, handles, file} = await plans(), {page, done} = await blank(browser);
  await page.goto(`${there}#plan=0123&step=4`);
  await page.locator('#plan-verdict strong', {hasText: 'NO SUCH PLAN'}).waitFor();
  assert.ok(await page.locator('#curves').isHidden());
  await shot(page, 'plan-unknown');
  await page.getByRole('button', {name: 'Open touch'}).click();
  await at(page);
  assert.equal(await page.locator('#plan').inputValue(), handles.touch);
  const asked = `**/api/plans/${handles.wall}`;
  let times = 0;
  await page.route(asked, async (route) => {
    const reply = await route.fetch(), json = await reply.json();
    await route.fulfill({response: reply, json: times++ === 0 ? {...json, check: null} : json});
  });
  await page.locator('#plan').selectOption(handles.wall);
  await page.locator('#plan-verdict strong', {hasText: 'CHECKING'}).waitFor();
  await page.locator('#plan-verdict strong', {hasText: 'CLEAR ONLY IF TAUT'}).waitFor();
  assert.equal(times, 2);
  await page.unroute(asked);
  await page.goto(`${url}#plan=${handles.wall}`);  // of a server that has none
  await page.locator('#status', {hasText: 'start sinew serve with --scene and --plan'}).waitFor();
  assert.ok(await page.locator('#screens').isHidden());
  const refused = spawnSync(sinew, ['serve', '--scene', file('wall.yaml'), '--plan', file('other.csv'), '--port', '0'], {encoding: 'utf8'});
  assert.equal(refused.status, 2);
  assert.match(refused.stderr, /has no column S4_beta_1; a plan of this robot has \[missing_column\]/);
  await done(/404/);
}

/** However fast a hand is, one request is on its way, and the next one is for where it has come to. */
export async function plan_keeps_up(browser) {
  const {page, done} = await see(browser, 'wall', {}, '&step=10');
  await page.evaluate(() => window.__sinew.way.forgetShapes());
  const kept = await hold(page);
  for (const to of ['200', '150', '100', '60']) await page.locator('#transport input').fill(to);
  await kept.arrival(1);
  assert.equal(await step(page), 60);
  await new Promise((next) => setTimeout(next, 200));
  assert.equal(kept.asked.length, 1, 'more than one request is on its way');
  kept.next();
  await kept.arrival(2);
  const {steps} = await page.evaluate(async () => (await fetch(`/api/plans/${document.getElementById('plan').value}`)).json());
  assert.deepEqual(JSON.parse(kept.asked[1])[0].configuration, steps[60].configuration);
  await kept.release();
  await at(page, 60);
  await done();
}

/** By WebGL: the solids, cut or not, at both sizes and in both themes. */
export async function plan_pictures(browser) {
  for (const [width, height] of [[1280, 800], [390, 844]]) {
    const {page, done} = await see(browser, 'wall', {width, height}, '&step=276');
    const view = async () => {
      const {x, y, width: wide, height: high} = await page.locator('#way-view').boundingBox(), tools = 48;
      return page.screenshot({clip: {x, y: y + tools, width: wide, height: high - tools}});
    };
    await page.locator('#plan-checks .facts', {hasText: 'tendon change'}).waitFor({state: 'attached'});
    await drawn(page);
    for (const theme of ['light', 'dark']) {
      await page.emulateMedia({colorScheme: theme});
      await drawn(page);
      await audit(page, `plan ${width} ${theme}`);
      await shot(page, `plan-${width}-${theme}`);
    }
    const cut = await view();
    await page.keyboard.press('k');
    await drawn(page);
    const whole = await view();
    differs(whole, cut, 'clip');
    await page.keyboard.press('k');
    await drawn(page);
    same(await view(), cut, 'clip and back');
    await page.keyboard.press(',');
    await at(page, 275);
    differs(await view(), cut, 'a step');
    if (width < 720) {
      for (const target of await page.locator('#transport button, #transport select, #way-tabs button, #screens button:visible').all()) assert.ok((await target.boundingBox()).height >= 44);
      await page.getByRole('button', {name: 'Checks'}).click();
      await audit(page, 'checks of a phone');
      await shot(page, 'plan-phone-checks');
      await page.getByRole('button', {name: 'Curves'}).click();
    }
    await fits(page);
    await done();
  }
}
