// From a slider's step to the picture of its answer, and how often pictures come. Printed, not judged: machines differ.
// What is measured briefly says only that it can be: numbers to quote are those of a thorough run.
import {blank, isThorough, open, rested, settled, then} from './harness.mjs';

const [steps, lasts, visits] = isThorough ? [300, 2000, 5] : [40, 300, 1];

export async function latency(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr');
  /** @param pause [ms] between an answer and the next step: none says what a browser bears, some what a hand feels */
  const measure = (pause) => page.evaluate(async ([wait, count]) => {
    const slider = document.querySelector('#inputs input[type=range]'), root = document.documentElement, times = [];
    const answered = (last) => new Promise((done) => {
      const watch = new MutationObserver(() => {
        if (root.dataset.answers === last) return;
        watch.disconnect();
        done();
      });
      watch.observe(root, {attributes: true});
    });
    for (let i = 0; i < count; ++i) {
      const begin = performance.now(), answer = answered(root.dataset.answers);
      slider.value = String(Number(slider.value) + (i % 40 < 20 ? 1e-4 : -1e-4));
      slider.dispatchEvent(new Event('input'));
      await answer;
      times.push(performance.now() - begin);
      if (wait > 0) await new Promise((next) => setTimeout(next, wait));
    }
    return times.sort((a, b) => a - b);
  }, [pause, steps]);
  for (const [pause, what] of [[40, 'a step each 40 ms'], [0, 'one step after the other']]) {
    const times = await measure(pause);
    console.log(`  slider to new pose, ${what}: median ${times[steps / 2].toFixed(1)} ms, 95 % ${times[0.95 * steps].toFixed(1)} ms`);
  }
  // first another one: an address that the page has already asks for nothing
  for (const robot of ['6-ufs', 'hexapod', 'nottingham-tpcj', '3-rfr']) {
    await then(page, () => page.goto(`${url}#robot=${robot}`));
    await rested(page);
    const rate = await page.evaluate(async (time) => {
      const slider = document.querySelector('#inputs input[type=range]'), step = (slider.max - slider.min) / 200, begin = performance.now(), first = window.__sinew.scene.frames;
      for (let i = 0; performance.now() < begin + time; ++i) {
        slider.value = String(Number(slider.value) + (i % 40 < 20 ? step : -step));
        slider.dispatchEvent(new Event('input'));
        await new Promise((next) => requestAnimationFrame(next));
      }
      return (window.__sinew.scene.frames - first) / (performance.now() - begin) * 1000;
    }, lasts);
    console.log(`  new poses of ${robot} drawn while it moves: ${rate.toFixed(0)} a second`);
  }
  await done();
}

export async function first_picture(browser, url) {
  const times = [];
  for (let i = 0; i < visits; ++i) {
    const {page, done} = await blank(browser, {isOwn: true}), begin = performance.now();
    await page.goto(`${url}#robot=3-rfr`);
    await settled(page, 0);
    times.push(performance.now() - begin);
    await done();
  }
  console.log(`  first picture after ${times.map((time) => time.toFixed(0)).join(', ')} ms`);
}
