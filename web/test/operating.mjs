// What tests of the screen Operate share: waiting for what it draws, a stand-in for a device.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {blank, drawn} from './harness.mjs';
import {framer, standIn} from './stand_in.mjs';

const robots = new URL('../../robots/', import.meta.url);
export const textOf = (name) => readFileSync(new URL(`${name}.yaml`, robots), 'utf8');
export const sizes = [[1280, 800], [390, 844]], themes = ['light', 'dark'];
export const degree = Math.PI / 180;

export const draws = (page) => page.evaluate(() => Number(document.documentElement.dataset.operated ?? 0));

/** Waits for what the page draws to be as a test of it says. */
export const until = async (page, is, ...values) => {
  for (let tries = 0; !await page.evaluate(is, ...values); ++tries) {
    assert.ok(tries < 1200, `it did not come: ${is}`);
    await new Promise((next) => setTimeout(next, tries < 20 ? 10 : 100));
  }
  await drawn(page);
};
export const operated = (page, after) => until(page, (count) => Number(document.documentElement.dataset.operated ?? 0) > count, after);
export const frame = (page) => page.evaluate(() => window.__sinew.operate.frame);
export const word = (page, section) => page.locator('.section .word').nth(section).innerText();

export async function see(browser, url, robot, more = '', options = {}) {
  const opened = await blank(browser, options);
  await opened.page.goto(`${url}#robot=${robot}&screen=operate${more}`);
  await operated(opened.page, 0);
  return opened;
}

/** Does something and waits for the last answer of the arm of sliders: a drag asks many times, and a busy machine answers some of them only. */
export async function answered(page, act) {
  const before = await page.evaluate(() => window.__sinew.operate.frame.time);
  await act();
  await drawn(page);  // moves of a pointer come with the next picture
  await until(page, (time) => window.__sinew.operate.frame.time > time && !window.__sinew.operate.subject.isAsking, before);
}

export const bends = [[0.1, -0.05], [-0.1, 0.1], [0.05, 0.1], [0.1, 0.2], [0.1, 0.05]];
export const alarm = (section, word, next, more = 0) => ({section, word, since: 3.2, sentence: '', did: 'Motion is held.', next, more, acknowledged: false});

export async function device(url, robot, info) {
  const text = textOf(robot), stand = await standIn(url, robot, text, info), make = await framer(url, text);
  for (const [kind, what] of [['info', 'device found'], ['info', 'homed, 15/15'], ['info', 'armed'], ['slack', 'S3 SLACK 0.75 mm'], ['over', 'S4 OVER-TENSIONED 0.70 mm']]) stand.log({time: 1, clock: '10:42:17', kind, text: what});
  return {stand, make};
}

/** A page with a device that tells of itself. */
export async function control(browser, url, options) {
  const {stand, make} = await device(url, 'nottingham-tpcj');
  stand.push(await make(bends));
  const {page, done} = await blank(browser, options), telling = setInterval(() => stand.push(stand.frame), 50);
  await page.goto(stand.url);
  await operated(page, 0);
  return {stand, make, page, done: async (allowed) => {
    clearInterval(telling);
    await done(allowed ?? /409|ERR_/);
    stand.close();
  }};
}

export const bar = (page, name) => page.locator('#op-bar').getByRole('button', {name});
export const pause = (ms) => new Promise((next) => setTimeout(next, ms));
export const arrived = async (stand, is) => {
  for (let tries = 0; !is(); ++tries) {
    assert.ok(tries < 600, `it was not said: ${is}`);
    await pause(20);
  }
};
