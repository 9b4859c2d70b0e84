// From a slider's step to the picture of its answer, and how often pictures come. Printed, not judged: machines differ.
import {open, blank, settled} from './harness.mjs';

export async function latency(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr');
  const times = await page.evaluate(async () => {
    const slider = document.querySelector('#inputs input[type=range]'), root = document.documentElement, times = [];
    for (let i = 0; i < 400; ++i) {
      const count = root.dataset.answers, begin = performance.now();
      slider.value = String(Number(slider.value) + (i % 40 < 20 ? 1e-4 : -1e-4));
      slider.dispatchEvent(new Event('input'));
      while (root.dataset.answers === count) await new Promise((next) => setTimeout(next, 0));
      times.push(performance.now() - begin);
    }
    return times.sort((a, b) => a - b);
  });
  console.log(`  slider to new pose: median ${times[200].toFixed(1)} ms, 95 % ${times[380].toFixed(1)} ms`);
  for (const robot of ['3-rfr', '6-ufs', 'hexapod', 'nottingham-tpcj']) {
    await page.goto(`${url}#robot=${robot}`);
    await page.waitForTimeout(800);
    const rate = await page.evaluate(async () => {
      const slider = document.querySelector('#inputs input[type=range]'), step = (slider.max - slider.min) / 200, begin = performance.now(), first = window.__sinew.scene.frames;
      for (let i = 0; performance.now() < begin + 2000; ++i) {
        slider.value = String(Number(slider.value) + (i % 40 < 20 ? step : -step));
        slider.dispatchEvent(new Event('input'));
        await new Promise((next) => requestAnimationFrame(next));
      }
      return (window.__sinew.scene.frames - first) / (performance.now() - begin) * 1000;
    });
    console.log(`  new poses of ${robot} drawn while it moves: ${rate.toFixed(0)} a second`);
  }
  await done();
}

export async function first_picture(browser, url) {
  const times = [];
  for (let i = 0; i < 5; ++i) {
    const {page, done} = await blank(browser), begin = performance.now();
    await page.goto(`${url}#robot=3-rfr`);
    await settled(page, 0);
    times.push(performance.now() - begin);
    await done();
  }
  console.log(`  first picture after ${times.map((time) => time.toFixed(0)).join(', ')} ms`);
}
