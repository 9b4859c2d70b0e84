// node page.mjs SINEW CHROMIUM FOLDER [CASE ...]: the page of sinew serve in a real browser; screenshots go to FOLDER.
import * as design from './design.mjs';
import * as errors from './errors.mjs';
import {launch, serve} from './harness.mjs';
import * as honest from './honest.mjs';
import * as looks from './looks.mjs';
import * as speed from './speed.mjs';

const wanted = process.argv.slice(5), {server, url} = await serve(), browser = await launch();
try {
  for (const [name, run] of Object.entries({...design, ...errors, ...honest, ...looks, ...speed})) {
    if (wanted.length > 0 && !wanted.includes(name)) continue;
    const begin = performance.now();
    await run(browser, url).catch((error) => { throw new Error(`${name}: ${error.message}`, {cause: error}); });
    console.log(`${name}: ${((performance.now() - begin) / 1000).toFixed(1)} s`);
  }
} finally {
  await browser.close();
  server.kill('SIGINT');
}
