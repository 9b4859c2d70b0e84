// Sizes, colours and what a screen reader finds.
import assert from 'node:assert/strict';
import {audit, fits, isThorough, open, rested, shot, tab, then} from './harness.mjs';

const channel = (value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);
const luminance = (hex) => {
  const [r, g, b] = [1, 3, 5].map((at) => channel(parseInt(hex.slice(at, at + 2), 16) / 255));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const contrast = (a, b) => {
  const [light, dark] = [luminance(a), luminance(b)].sort((x, y) => y - x);
  return (light + 0.05) / (dark + 0.05);
};

/** Text stands out by 4.5 to 1 from all it is on, shapes and borders of controls by 3 to 1. */
export async function contrasts(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr');
  for (const theme of ['light', 'dark']) {
    await page.emulateMedia({colorScheme: theme});
    const colour = await page.evaluate(() => {
      const style = getComputedStyle(document.documentElement);
      return Object.fromEntries(['bg', 'panel', 'card', 'scene', 'text', 'mute', 'ctl', 'accent', 'on-accent', 'exact', 'slack', 'over', 'unreachable', 'stale', 'tendon-1', 'tendon-2', 'tendon-3', 'tendon-4', 'pull-0', 'pull-1', 'pull-2', 'pull-3']
        .map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
    });
    const check = (names, grounds, least) => {
      for (const name of names) for (const ground of grounds) {
        const found = contrast(colour[name], colour[ground]);
        assert.ok(found >= least, `${theme}: ${name} on ${ground} is ${found.toFixed(2)}`);
      }
    };
    check(['text', 'mute'], ['bg', 'panel', 'card', 'scene'], 4.5);
    check(['on-accent'], ['accent'], 4.5);
    check(['accent', 'over'], ['panel', 'card'], 4.5);
    check(['ctl'], ['panel', 'card'], 3);
    check(['exact', 'slack', 'over', 'unreachable', 'stale'], ['card', 'panel', 'scene'], 3);
    check(['tendon-1', 'tendon-2', 'tendon-3', 'tendon-4'], ['scene', 'panel'], 3);
    check(['pull-0', 'pull-1', 'pull-2', 'pull-3'], ['scene'], 3);
  }
  await done();
}

/** Rules of accessibility, by axe, on each tab at both sizes, in a theme each or thoroughly in both, and on the start. */
export async function accessibility(browser, url) {
  for (const [width, height] of [[1280, 800], [390, 844]]) {
    const {page, done} = await open(browser, url, '3pfs-g2', {width, height});
    const inBoth = async (what, see = () => undefined) => {
      for (const theme of isThorough ? ['light', 'dark'] : [width < 720 ? 'dark' : 'light']) {
        await page.emulateMedia({colorScheme: theme});
        await audit(page, `${what} ${width} ${theme}`);
        await see(theme);
      }
    };
    for (const name of ['Inputs', 'Pose', 'Load', 'Model', 'File', ...(width < 720 ? ['Margins'] : [])]) {
      await tab(page, name);
      await rested(page);
      await inBoth(name, (theme) => width < 720 && shot(page, `phone-${name.toLowerCase()}-${theme}`));
    }
    await page.locator('#brand').click();
    await page.locator('.robot').first().waitFor();
    await inBoth('start');
    await done();
  }
}

/** Between phone and desk the answer is a drawer; on wide screens the panels grow; the sheet of a phone is dragged. */
export async function sizes(browser, url) {
  const drawer = await open(browser, url, '6-ufs', {width: 1100, height: 760});
  await drawer.page.locator('#verdict').waitFor({state: 'hidden'});
  await drawer.page.locator('#view').press(']');
  await drawer.page.locator('#verdict').waitFor();
  await drawer.page.evaluate(() => Promise.all(document.getAnimations().map(({finished}) => finished)));
  await shot(drawer.page, 'drawer');
  await drawer.page.keyboard.press('Escape');
  await drawer.page.locator('#verdict').waitFor({state: 'hidden'});
  await drawer.done();

  const wide = await open(browser, url, '6-ufs', {width: 1680, height: 1000});
  assert.equal((await wide.page.locator('#left').boundingBox()).width, 380);
  await shot(wide.page, 'wide');
  await wide.done();

  const phone = await open(browser, url, '3pfs-g2', {width: 390, height: 844, hasTouch: true}), {page} = phone;
  const height = async () => (await page.locator('#left').boundingBox()).height, handle = await page.locator('#handle').boundingBox(), before = await height();
  assert.equal(before, 406);
  await page.mouse.move(handle.x + 100, handle.y + 8);
  await page.mouse.down();
  await page.mouse.move(handle.x + 100, handle.y + 240, {steps: 5});
  await page.mouse.up();
  assert.equal(await height(), 120);
  await shot(page, 'phone-sheet-low');
  await page.locator('#handle').press('ArrowUp');
  assert.equal(await height(), 406);
  for (const target of await page.locator('#left button:visible, #left input:not([type=range]):visible, header button:visible, header select:visible').all()) {
    const box = await target.boundingBox();
    assert.ok(box.height >= 44, `${await target.evaluate((of) => of.outerHTML)} is ${box.height} px high`);
  }
  await then(page, () => page.locator('.step').nth(1).click());
  await fits(page);
  await phone.done();
}

/** Print and reduced motion: the day's colours, nothing that moves. */
export async function paper(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr', {theme: 'dark', reducedMotion: 'reduce'});
  await page.emulateMedia({media: 'print'});
  await page.locator('header').waitFor({state: 'hidden'});
  assert.equal(await page.evaluate(() => getComputedStyle(document.body).color), 'rgb(27, 36, 48)');
  await page.emulateMedia({media: 'screen'});
  await done();
}
