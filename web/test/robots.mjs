// Every robot that ships, by its sliders.
import assert from 'node:assert/strict';
import {answer, blank, differs, fits, isThorough, picture, rested, shot, then, verdict} from './harness.mjs';

/**
 * Every robot, each slider of it: it moves the answer, and the picture, which is looked at for one slider of six, in turn, or
 * thoroughly for all. One slider at another size or in the other theme, which have nothing to do with what a robot is: each
 * robot in one of the other ways to look, in turn, or thoroughly in all of them.
 */
export async function everyRobot(browser, url) {
  const robots = (await (await fetch(new URL('/api/robots', url))).json()).robots;
  for (const [way, [width, height, theme]] of [[1280, 800, 'light'], [390, 844, 'dark'], [1280, 800, 'dark'], [390, 844, 'light']].entries()) {
    const {page, done} = await blank(browser, {width, height, theme}), isWhole = way === 0;
    for (const [turn, {name}] of robots.filter((_, i) => isWhole || isThorough || i % 3 === way - 1).entries()) {
      await then(page, () => page.goto(`${url}#robot=${name}`));
      assert.match(await verdict(page), /SOLVED/, name);
      assert.equal(await page.locator('#robot').inputValue(), name);
      const sliders = page.locator('#inputs input[type=range]'), count = isWhole ? await sliders.count() : 1;
      for (let i = 0; i < count; ++i) {
        const isSeen = isThorough || count === 1 || (turn + i) % 6 === 0, said = await answer(page);
        const before = isSeen && await picture(page);  // anew: slower answers and notes have come since the last
        await then(page, () => sliders.nth(i).press('ArrowRight'));
        if (width === 1280) assert.notEqual(await answer(page), said, `${name}, slider ${i + 1}: the answer did not change`);
        if (isSeen) differs(await picture(page), before, `${name}, slider ${i + 1}`);
      }
      await fits(page);
      if (isWhole) {
        await then(page, () => sliders.last().press('0'));
        if (name !== 'hexapod-torsion') await rested(page);  // whose strip takes some seconds
      }
      await shot(page, `${name}-${width}-${theme}`);
    }
    await done();
  }
}
