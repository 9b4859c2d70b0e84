// From a slider's step to the picture of its answer, and how often pictures come. Printed, not judged: machines differ.
import {open, blank, settled} from './harness.mjs';

export async function latency(browser, url) {
  const {page, done} = await open(browser, url, '3-rfr');
  /** @param pause [ms] between an answer and the next step: none says what a browser bears, some what a hand feels */
  const measure = (pause) => page.evaluate(async (wait) => {
    const slider = document.querySelector('#inputs input[type=range]'), root = document.documentElement, times = [];
    const answered = (count) => new Promise((done) => {
      const watch = new MutationObserver(() => {
        if (root.dataset.answers === count) return;
        watch.disconnect();
        done();
      });
      watch.observe(root, {attributes: true});
    });
    for (let i = 0; i < 300; ++i) {
      const begin = performance.now(), answer = answered(root.dataset.answers);
      slider.value = String(Number(slider.value) + (i % 40 < 20 ? 1e-4 : -1e-4));
      slider.dispatchEvent(new Event('input'));
      await answer;
      times.push(performance.now() - begin);
      if (wait > 0) await new Promise((next) => setTimeout(next, wait));
    }
    return times.sort((a, b) => a - b);
  }, pause);
  for (const [pause, what] of [[40, 'a step each 40 ms'], [0, 'one step after the other']]) {
    const times = await measure(pause);
    console.log(`  slider to new pose, ${what}: median ${times[150].toFixed(1)} ms, 95 % ${times[285].toFixed(1)} ms`);
  }
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
    const {page, done} = await blank(browser, {isOwn: true}), begin = performance.now();
    await page.goto(`${url}#robot=3-rfr`);
    await settled(page, 0);
    times.push(performance.now() - begin);
    await done();
  }
  console.log(`  first picture after ${times.map((time) => time.toFixed(0)).join(', ')} ms`);
}
