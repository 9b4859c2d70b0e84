// node scene.mjs SINEW CHROMIUM FOLDER [CASE ...]: pictures alone, without the page round them, by WebGL and by SVG.
import assert from 'node:assert/strict';
import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {inflateSync} from 'node:zlib';
import {bench} from './bench.mjs';
import {blank, differs, folder, isThorough, launch, same, serve} from './harness.mjs';

const layers = ['rods', 'tendons', 'discs', 'frames', 'lines', 'labels', 'ghost', 'grid'], views = ['side', 'top', 'front', 'tip'];

/** What a robot is drawn at: arms bent, so that they show more than a line; of elastic ones some tendons pulled. */
const pose = `(inputs, rows) => inputs.map((value, i) => (rows[i].unit === 'N' ? [0.5, 0, 0.2, 0][i % 4] * rows[i].high : rows[i].path.startsWith('sections') && rows[i].unit === 'rad' ? [0.5, 0.3, 0.6, -0.2, 0.4][i % 5] : value))`;

class Stand {
  constructor(page, done) {
    Object.assign(this, {page, done});
  }

  /** @param part of a drawing that is other than at home */
  async draw(name, part = '{}') {
    await this.page.evaluate(`(async () => {
      const {picture, drawing} = bench, first = await drawing(${JSON.stringify(name)}, ${pose});
      window.drawn = {...first, ...${part}};
      picture.draw(drawn);
    })()`);
    return this.shot();
  }

  async shot(name) {
    await this.page.evaluate(() => bench.still());
    return this.page.screenshot(name && {path: join(folder, `scene-${name}.png`)});
  }

  /** Of the picture. */
  async do(what) {
    await this.page.evaluate(`{ const {picture, told} = bench; ${what} }`);
    return this.shot();
  }

  get(what) {
    return this.page.evaluate(`(() => { const {picture, told, box} = bench; return ${what}; })()`);
  }
}

async function stand(browser, url, {theme = 'light', ...size} = {}) {
  const {page, done} = await blank(browser, {theme, ...size});
  await page.goto(url);
  for (let i = 0; i < 200 && !(await page.evaluate(() => !!window.bench)); ++i) await page.waitForTimeout(20);
  await page.evaluate((name) => {
    document.documentElement.dataset.theme = name;
    bench.paint();
  }, theme);
  return new Stand(page, done);
}

/** The numbers of a PNG's pixels and its chunks of text. */
function decode(bytes) {
  const chunks = [];
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at)) {
    const size = bytes.readUInt32BE(at), data = bytes.subarray(at + 8, at + 8 + size);
    assert.equal(bytes.readUInt32BE(at + 8 + size), crc(bytes.subarray(at + 4, at + 8 + size)), 'a chunk without its sum');
    chunks.push({type: bytes.toString('latin1', at + 4, at + 8), data});
  }
  const head = chunks[0].data, width = head.readUInt32BE(0), height = head.readUInt32BE(4), channels = {2: 3, 6: 4}[head[9]];
  const text = chunks.filter(({type}) => type === 'iTXt').map(({data}) => data.toString('utf8').split('\0')).map((parts) => [parts[0], parts.at(-1)]);
  const raw = inflateSync(Buffer.concat(chunks.filter(({type}) => type === 'IDAT').map(({data}) => data))), row = width * channels, pixels = Buffer.alloc(row * height);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < row; ++x) {
      const left = x < channels ? 0 : pixels[y * row + x - channels], up = y === 0 ? 0 : pixels[(y - 1) * row + x], corner = x < channels || y === 0 ? 0 : pixels[(y - 1) * row + x - channels];
      pixels[y * row + x] = raw[y * (row + 1) + 1 + x] + [0, left, up, (left + up) >> 1, paeth(left, up, corner)][raw[y * (row + 1)]];
    }
  return {width, height, text, colour: (x, y) => [...pixels.subarray(y * row + x * channels, y * row + x * channels + 3)], count: new Set(Array.from({length: width * height}, (_, i) => pixels.readUIntBE(i * channels, 3))).size};
}

function paeth(left, up, corner) {
  const guess = left + up - corner, [a, b, c] = [left, up, corner].map((value) => Math.abs(guess - value));
  return a <= b && a <= c ? left : b <= c ? up : corner;
}

function crc(bytes) {
  let sum = ~0;
  for (const byte of bytes) {
    sum ^= byte;
    for (let bit = 0; bit < 8; ++bit) sum = (sum >>> 1) ^ (sum & 1 ? 0xedb88320 : 0);
  }
  return ~sum >>> 0;
}

/** Every robot that ships, day and dark: all of it in view, more than one colour. */
async function robots(browser, url, kind) {
  const all = (await (await fetch(new URL('/api/robots', url))).json()).robots;
  for (const theme of ['light', 'dark']) {
    const on = await stand(browser, url, {width: 670, height: 544, theme});
    for (const {name} of all) {
      await on.do('picture.clear()');
      await on.draw(name);
      await on.do('picture.fit()');
      const seen = decode(await on.shot(`${kind}-${name}-${theme}`));
      assert.ok(seen.count > 30, `${name}: nothing is drawn`);
      const edge = seen.colour(669, 543);
      for (let x = 0; x < 670; ++x) assert.deepEqual(seen.colour(x, 1), edge, `${name} is cut at the top`);
      for (let y = 0; y < 544; ++y) assert.deepEqual([seen.colour(1, y), seen.colour(668, y)], [edge, edge], `${name} is cut at a side`);
    }
    await on.done();
  }
}

/** Each layer, and each thing that a drawing can have besides, changes the picture; taken away it is the same again. */
async function parts(browser, url, kind) {
  const on = await stand(browser, url, {width: 670, height: 544});
  for (const [name, has] of [['6-ufs', ['rods', 'tendons', 'frames', 'lines', 'labels', 'grid']], ['nottingham-tpcj', ['rods', 'tendons', 'discs', 'frames', 'labels', 'grid']], ['3-rfr', ['lines', 'labels']]]) {
    await on.do('picture.clear(); picture.camera = ""');
    const before = await on.draw(name);
    for (const layer of has) {
      const isShown = ['rods', 'tendons', 'discs', 'frames', 'ghost'].includes(layer), other = await on.do(`picture.show('${layer}', ${!isShown})`);
      if (!(layer === 'rods' && name === 'nottingham-tpcj' && kind === 'webgl')) differs(other, before, `${name}: the layer ${layer}`);  // discs may hide them all
      same(await on.do(`picture.show('${layer}', ${isShown})`), before, `${name}: the picture without and with ${layer}`);
    }
  }
  await on.do('picture.clear(); picture.camera = ""');
  const before = await on.draw('6-ufs');
  for (const [what, part] of Object.entries({
    ghost: `{ghost: (await drawing('6-ufs', (inputs) => inputs.map((value) => value + 0.004))).shape}`, stale: '{isStale: true}', unstable: '{isUnstable: true}', meeting: '{meeting: [0.02, 0, 0.1]}',
    shift: '{isUnstable: true, directions: [[1, 0, 0, 0, 0, 0]]}', turn: '{isUnstable: true, directions: [[0, 0, 0, 0, 0, 1]]}', force: '{wrench: [0, 0, -5.1, 0, 0, 0]}', moment: '{wrench: [0, 0, 0, 0, 0.2, 0]}',
  })) {
    differs(await on.draw('6-ufs', part), before, what);
    await on.shot(`${kind}-${what}`);
    if (what === 'force') assert.match(await on.page.locator('#view').innerText(), /5\.1 N$/m);
    if (what === 'moment') assert.match(await on.page.locator('#view').innerText(), /0\.2 N m/);
    same(await on.draw('6-ufs'), before, `the picture after ${what}`);
  }
  await on.draw('nottingham-tpcj', `{states: ['●', '▼', '⊗', '▧', '●']}`);
  await on.do('picture.fit()');
  assert.equal(await on.page.locator('.label.state:visible').allInnerTexts().then((all) => all.join('')), '●▼⊗▧●');
  await on.shot(`${kind}-states`);
  await on.done();
}

/** Of an arm's tendons one sees what they pull, and which are slack and by how much; forces on it are arrows. Taken back the picture is the same. */
async function tendons(browser, url, kind) {
  const on = await stand(browser, url, {width: 670, height: 544}), loads = () => on.page.locator('.label.load:visible').allInnerTexts();
  const before = await on.draw('two-segment'), pulls = (tensions, slack = '[[0, 0, 0], [0, 0, 0]]') => `{pulls: {tensions: ${tensions}, slack: ${slack}, most: 5}}`;
  const seen = [before];
  for (const [what, part] of Object.entries({
    little: pulls('[[1, 0, 0], [0, 1, 0]]'), much: pulls('[[5, 0, 0], [0, 1, 0]]'), loose: pulls('[[0, 0, 0], [0, 0, 0]]'), slack: pulls('[[0, 0, 0], [0, 0, 0]]', '[[0.01, 0.02, 0.01], [0.02, 0.01, 0]]'),
    force: '{loads: [{at: [0, 0, 0.2], force: [0, 0.35, 0]}]}',
  })) {
    const one = await on.draw('two-segment', part);
    for (const other of seen) differs(one, other, what);
    seen.push(one);
    await on.shot(`${kind}-tendons-${what}`);
    assert.deepEqual(await loads(), what === 'force' ? ['0.35 N'] : []);
    same(await on.draw('two-segment'), before, `the picture after ${what}`);
  }
  // Discs have a thickness, whether the file says their radius or not: flat ones are black.
  for (const radius of [0, 0.014]) {
    await on.draw('two-segment', `(await drawing('two-segment', ${pose}, (shape) => ({...shape, discs: shape.discs.map((disc) => ({...disc, radius: ${radius}}))})))`);
    const discs = await on.get('drawn.shape.discs.map(({radius, height}) => [radius, height])');
    assert.ok(discs.every(([wide, high]) => wide === (radius || 0.0115) && high > 0), JSON.stringify(discs));
  }
  await on.draw('two-segment', pulls('[[5, 0, 0], [0, 1, 0]]'));
  // The scale of their colours is in what is saved, too.
  const large = decode(Buffer.from(await on.page.evaluate(async () => [...new Uint8Array(await (await bench.picture.save('')).arrayBuffer())]))), {x, y, width, height} = await on.page.locator('.pulls .ramp').boundingBox();
  const [low, high] = [0.02, 0.98].map((part) => large.colour(Math.round(2 * (x + part * width)), Math.round(2 * y + height)));
  assert.ok([[low, [0x7C, 0x7B, 0x78]], [high, [0x00, 0x22, 0x4E]]].every(([seen, wanted]) => seen.every((part, k) => Math.abs(part - wanted[k]) < 8)), `the scale goes from ${low} to ${high}`);
  // An arc of the slack between each two guides is as much longer as it says.
  const longer = await on.page.evaluate(() => {
    const {tendons} = bench.picture.drawing.shape, lengthOf = (points) => points.reduce((sum, point, i) => (i > 0 ? sum + Math.hypot(...point.map((part, k) => part - points[i - 1][k])) : 0), 0);
    return bench.bowed(tendons[1][0], tendons.flat(), 0.004) && lengthOf(bench.bowed(tendons[1][0], tendons.flat(), 0.004)) - lengthOf(tendons[1][0]);
  });
  assert.ok(Math.abs(longer - 0.004) < 0.0004, `4 mm of slack are drawn as ${(1000 * longer).toFixed(2)} mm`);
  await on.done();
}

/** Views, pointer, wheel and keys change what is seen; the camera's text brings it back to the pixel; fit undoes it all. */
async function cameras(browser, url) {
  for (const name of ['6-ufs', '3-rfr']) {
    const on = await stand(browser, url, {width: 670, height: 544}), isPlanar = name === '3-rfr', {page} = on;
    const fitted = await on.draw(name);
    const moves = {
      ...(!isPlanar && {...Object.fromEntries(views.map((view) => [view, () => on.do(`picture.fit('${view}')`)])), lens: () => on.do('picture.toggleProjection()')}),  // a lens above a plane sees the same
      drag: () => drag(page, [500, 480], [560, 450]), pan: () => drag(page, [500, 480], [560, 450], 'right'), wheel: () => wheel(page, [400, 300], -300),
      arrow: () => page.locator('#view').press('ArrowLeft'), plus: () => page.locator('#view').press('+'),
    };
    for (const [what, move] of Object.entries(moves)) {
      await move();
      await page.evaluate(() => document.activeElement.blur());
      await page.mouse.move(2, 2);
      await page.waitForTimeout(250);  // a wheel's end
      const seen = await on.shot(), text = await on.get('picture.camera');
      differs(seen, fitted, `${name}: the view after ${what}`);
      await on.do(`picture.fit(); picture.clear(); picture.camera = ${JSON.stringify(text)}`);
      same(await on.draw(name), seen, `${name}: the picture of camera=${text} after ${what}`);
      assert.equal(await on.get('picture.camera'), text);
      if (what === 'lens') await on.do('picture.toggleProjection()');
      same(await on.do('picture.fit()'), fitted, `${name}: what fits after ${what}`);
    }
    if (isPlanar) assert.match(await on.get('picture.camera'), /^-90,90,/, 'it is seen from above, always');
    await page.mouse.move(2, 2);
    await drag(page, [500, 480], [560, 450]);
    await page.mouse.dblclick(600, 500);
    await page.evaluate(() => document.activeElement.blur());
    same(await on.shot(), fitted, `${name}: a double click does not fit`);
    await on.do('picture.camera = "1,2,x,4,5,6"');
    assert.equal(await on.get('picture.camera'), '', 'what is no camera is none');
    same(await on.draw(name), fitted, 'what is no camera fits');
    await on.done();
  }
}

async function drag(page, from, to, button = 'left') {
  await page.mouse.move(...from);
  await page.mouse.down({button});
  await page.mouse.move((from[0] + to[0]) / 2, (from[1] + to[1]) / 2);
  await page.mouse.move(...to);
  await page.mouse.up({button});
}

async function wheel(page, at, by) {
  await page.mouse.move(...at);
  await page.mouse.wheel(0, by);
}

/** What is under the pointer stays there while it zooms. A turned top has z up again. */
async function lookout(browser, url) {
  const on = await stand(browser, url, {width: 670, height: 544});
  await on.draw('6-ufs');
  const [x, y] = [420, 190], point = await on.get(`picture.lookout.shift(${x} - 335, ${y} - 272).map((part, k) => part + picture.lookout.at[k])`);
  for (let i = 0; i < 5; ++i) await wheel(on.page, [x, y], -200);
  const [u, v] = await on.get(`picture.lookout.project(${JSON.stringify(point)})`);
  assert.ok(Math.hypot(u - x, v - y) < 0.1, `it moved by ${Math.hypot(u - x, v - y)} px`);
  await on.do(`picture.fit('top')`);
  await on.page.locator('#view').press('ArrowUp');
  await on.page.locator('#view').press('ArrowDown');
  await on.page.locator('#view').press('ArrowDown');
  const [base, above] = await on.get('[picture.lookout.project([0, 0, 0]), picture.lookout.project([0, 0, 0.1])]');
  assert.ok(Math.abs(base[0] - above[0]) < 1e-6 && above[1] < base[1], 'z is not up');
  await on.done();
}

/** Two fingers zoom and pan, one orbits. */
async function fingers(browser, url) {
  const on = await stand(browser, url, {width: 390, height: 500, hasTouch: true}), client = await on.page.context().newCDPSession(on.page);
  await on.draw('3pfs-g2');
  const touch = (type, ...points) => client.send('Input.dispatchTouchEvent', {type, touchPoints: points.map(([x, y], id) => ({x, y, id}))});
  const pixels = () => on.get('picture.lookout.pixels'), before = await pixels(), first = await on.shot();
  await touch('touchStart', [150, 300], [250, 300]);
  await touch('touchMove', [100, 300], [300, 300]);
  await touch('touchEnd');
  assert.ok(Math.abs((await pixels()) / before - 2) < 0.05, `twice as far apart is ${(await pixels()) / before} times as large`);
  const second = await on.shot();
  differs(second, first);
  await touch('touchStart', [350, 450]);
  await touch('touchMove', [300, 440]);
  await touch('touchMove', [250, 430]);
  await touch('touchEnd');
  differs(await on.shot(), second);
  await on.done();
}

/** The pointer on a part names it after a while; a click keeps the name, which follows its part; clicks after a drag do not. */
async function names(browser, url) {
  const on = await stand(browser, url, {width: 670, height: 544}), {page} = on, tip = page.locator('.tip');
  await on.draw('6-ufs');
  const middle = (what) => on.get(`picture.lookout.project(${what})`), [x, y] = await middle('drawn.shape.backbones[5][8]');
  // Both times are the page's own: a busy machine may look at it late.
  await page.evaluate(() => {
    const tip = document.querySelector('.tip');
    document.addEventListener('pointermove', ({timeStamp}) => { window.moved ??= timeStamp; }, {capture: true});
    new MutationObserver(() => { if (!tip.hidden) window.named ??= performance.now(); }).observe(tip, {attributes: true});
  });
  await page.mouse.move(x, y);
  await tip.waitFor();
  assert.ok(await page.evaluate('named - moved') >= 149, 'named at once');
  assert.equal(await tip.innerText(), 'backbone 5');
  await page.mouse.move(x - 60, y + 60);
  await tip.waitFor({state: 'hidden'});
  await page.mouse.click(x, y);
  await page.mouse.move(5, 5);
  assert.equal(await tip.innerText(), 'backbone 5');
  const before = await tip.boundingBox();
  await on.draw('6-ufs', `(await drawing('6-ufs', (inputs) => inputs.map((value) => value + 0.01)))`);
  assert.notDeepEqual(await tip.boundingBox(), before, 'the name does not follow');
  await page.locator('#view').press('Escape');
  assert.ok(await tip.isHidden(), 'Escape lets it go');
  await on.draw('6-ufs');
  await page.mouse.click(x, y);
  await page.mouse.click(x, y);
  assert.ok(await tip.isHidden(), 'a second click lets it go');
  await drag(page, [x, y], [x + 40, y]);
  await page.mouse.move(5, 5);
  assert.ok(await tip.isHidden(), 'what was dragged is named');
  await on.do('picture.fit()');
  const [a, b] = await middle('drawn.shape.tendons[5][1][20]');
  await page.mouse.move(a, b);
  await tip.waitFor();
  assert.equal(await tip.innerText(), 'tendon 5 1');
  await on.do(`picture.show('tendons', false); picture.show('rods', false)`);
  await page.mouse.move(a + 1, b);
  await page.waitForTimeout(300);
  assert.ok(await tip.isHidden() || /platform/.test(await tip.innerText()), 'what is hidden is named');
  await on.done();
}

/** The hand moves the platform as far as the pointer goes, in the plane of the screen, and says when it ends. */
async function hand(browser, url) {
  for (const name of ['6-ufs', '3-rfr']) {
    const on = await stand(browser, url, {width: 670, height: 544}), {page} = on;
    await on.draw(name);
    const before = await on.get('picture.camera'), place = await on.get('drawn.shape.frames.at(-1).position ?? [drawn.shape.frames.at(-1).x, drawn.shape.frames.at(-1).y, 0]');
    const project = (point) => on.get(`picture.lookout.project(${JSON.stringify(point)})`), [x, y] = await project(place);
    await page.mouse.move(x, y);
    assert.equal(await page.locator('#view').evaluate((view) => view.style.cursor), 'grab');
    await page.mouse.down();
    for (let i = 1; i <= 10; ++i) await page.mouse.move(x + 3 * i, y - 2 * i);
    await on.shot();
    await page.mouse.up();
    const grabbed = await on.get('told.grabbed'), last = grabbed.at(-1), [u, v] = await project(last.position);
    assert.ok(grabbed.length >= 2 && grabbed.length <= 12 && last.isEnd && grabbed.slice(0, -1).every(({isEnd}) => !isEnd), `told ${grabbed.length} times`);
    assert.ok(Math.hypot(u - x - 30, v - y + 20) < 0.5, `the platform went ${[u - x, v - y]} px`);
    const across = await on.get('picture.lookout.back'), deep = last.position.reduce((sum, part, k) => sum + (part - place[k]) * across[k], 0);
    assert.ok(Math.abs(deep) < 1e-12, 'it left the plane of the screen');
    assert.equal(await on.get('picture.camera'), before, 'the camera moved with the platform');  // pixels: browsers draw the edges beneath a label that goes anew, and not quite the same
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.up();
    assert.equal((await on.get('told.grabbed')).length, grabbed.length, 'a click drags nothing');
    await on.done();
  }
}

/** A saved picture has twice the size, the same look, and its command. */
async function saved(browser, url, kind) {
  const on = await stand(browser, url, {width: 600, height: 400}), command = 'sinew forward 3-rfr --inputs "0.19, 0.19" # θ';
  await on.draw('3-rfr', '{wrench: [0.02, 0.01, 0.003]}');
  const before = await on.shot();
  const bytes = Buffer.from(await on.page.evaluate(async (text) => [...new Uint8Array(await (await bench.picture.save(text)).arrayBuffer())], command));
  writeFileSync(join(folder, `scene-${kind}-saved.png`), bytes);
  const large = decode(bytes), small = decode(before);
  assert.deepEqual([large.width, large.height, large.text], [1200, 800, [['sinew', command]]]);
  assert.deepEqual(large.colour(10, 10), small.colour(5, 5));
  assert.ok(large.count > 30, 'nothing is saved');
  same(await on.shot(), before, 'the picture, while it was saved,');
  await on.done();
}

/** The bar is as long on the screen as what it says is; rods that are drawn too thick are said to be. */
async function scale(browser, url) {
  const on = await stand(browser, url, {width: 670, height: 544});
  for (const name of ['3pfs-g2', '3-rfr', 'nottingham-tpcj']) {
    await on.do('picture.clear(); picture.camera = ""');
    await on.draw(name);
    for (let i = 0; i < 6; ++i) {
      const text = await on.page.locator('.scale-bar').innerText(), [, number, unit] = /^([\d.]+) (mm|m)/.exec(text), metres = unit === 'm' ? Number(number) : Number(number) / 1000;
      const {width} = await on.page.locator('.scale-bar').boundingBox();
      const [[ax, ay], [bx, by]] = await on.get(`[picture.lookout.at, picture.lookout.at.map((part, k) => part + ${metres} * picture.lookout.right[k])].map((point) => picture.lookout.project(point))`);
      assert.ok(Math.abs(Math.hypot(bx - ax, by - ay) - width) < 1, `${text}: the bar has ${width} px, the way ${Math.hypot(bx - ax, by - ay)}`);
      assert.match(number, /^[125]0*$|^0\.0*[125]$/, `${text} is not round`);
      assert.equal(/not to scale/.test(text), await on.get('picture.notScaled'));
      assert.equal(await on.get('picture.notScaled'), 2 * (await on.get('drawn.radius')) * (await on.get('picture.lookout.pixels')) < 3);
      await wheel(on.page, [335, 272], -400);
      await on.page.waitForTimeout(30);
    }
  }
  await on.done();
}

/** What the camera says is where the pixels are: the ends of a rod, in both projections. */
async function places(browser, url) {
  const on = await stand(browser, url, {width: 670, height: 544});
  await on.draw('3pfs-g2');
  for (const projection of ['parallel', 'lens']) {
    if (projection === 'lens') await on.do('picture.toggleProjection(); picture.fit()');
    const seen = decode(await on.shot()), ground = seen.colour(669, 543);
    for (const points of [await on.get('drawn.shape.platform'), await on.get('drawn.shape.base')])
      for (const point of points) {
        const [x, y] = await on.get(`picture.lookout.project(${JSON.stringify(point)})`), colours = [-1, 0, 1].map((by) => seen.colour(Math.round(x + by - 0.5), Math.round(y - 0.5)));
        assert.ok(colours.some((colour) => colour.some((part, k) => Math.abs(part - ground[k]) > 20)), `${projection}: nothing at ${point}`);
      }
  }
  await on.done();
}

/** Nothing is drawn while nothing changes; a hidden canvas and a new size are drawn again. */
async function rest(browser, url) {
  const on = await stand(browser, url, {width: 670, height: 544});
  await on.draw('6-ufs');
  await on.page.waitForTimeout(100);
  const frames = await on.get('picture.frames');
  await on.page.waitForTimeout(500);
  assert.equal(await on.get('picture.frames'), frames, 'it is drawn while nothing changes');
  await on.page.setViewportSize({width: 500, height: 400});
  assert.ok(decode(await on.shot()).count > 30, 'nothing is drawn in a window of another size');
  await on.do('picture.clear()');
  assert.equal(await on.page.locator('.label:visible').count(), 0);
  await on.done();
}

/** How often pictures come. Printed; only a tenth of a second for one is wrong, since other work slows machines. */
async function speed(browser, url) {
  const on = await stand(browser, url);
  for (const name of ['3-rfr', '6-ufs', '3pfs-g2', 'hexapod', 'nottingham-tpcj']) {
    const rate = await on.page.evaluate(`(async () => {
      const {picture, drawing} = bench, two = [await drawing('${name}', ${pose}), await drawing('${name}', (inputs, rows) => (${pose})(inputs, rows).map((value) => 1.002 * value))];
      picture.clear();
      picture.camera = '';
      const first = picture.frames, begin = performance.now();
      for (let i = 0; performance.now() < begin + 2500; ++i) {
        picture.draw(two[i % 2]);
        await new Promise((next) => requestAnimationFrame(next));
      }
      return (1000 * (picture.frames - first)) / (performance.now() - begin);
    })()`);
    console.log(`  ${name} at 1280 x 800: ${rate.toFixed(0)} pictures a second`);
    assert.ok(rate > 10, `${name}: ${rate} pictures a second`);
  }
  await on.done();
}

/** A browser that draws slowly leaves details out and says so once; one that waits for answers does not. */
async function slow(browser, url) {
  const draw = (on, wait) => on.page.evaluate(`(async () => {
    for (const begin = performance.now(); performance.now() < begin + 5000;) {
      bench.picture.draw(drawn);
      await new Promise((next) => setTimeout(next, ${wait}));
    }
  })()`);
  const waits = await stand(browser, url, {width: 400, height: 300});
  await waits.draw('nottingham-tpcj');
  await draw(waits, 120);
  assert.deepEqual(await waits.get('told.notes'), []);
  await waits.done();
  const on = await stand(browser, url, {width: 400, height: 300});
  const before = await on.draw('nottingham-tpcj');
  await on.page.evaluate(() => { window.requestAnimationFrame = (go) => setTimeout(() => go(performance.now()), 70); });
  await draw(on, 5);
  assert.deepEqual(await on.get('told.notes'), ['drawn with fewer details: this browser draws slowly']);
  differs(await on.shot('few-details'), before);
  await on.done();
}

/** Small pictures: light, within their size, none of them empty. */
async function sketches(browser, url) {
  const all = (await (await fetch(new URL('/api/robots', url))).json()).robots, on = await stand(browser, url, {width: 1280, height: 900});
  await on.page.evaluate(() => { document.getElementById('view').hidden = true; });
  for (const [width, height] of [[84, 84], [168, 112], [240, 160]])
    for (const {name} of all) {
      const found = await on.page.evaluate(`(async () => {
        const {drawing, sketch} = bench, {shape, isPlanar} = await drawing('${name}', ${pose}), svg = sketch(shape, isPlanar, {width: ${width}, height: ${height}});
        document.getElementById('small').append(svg);
        const box = [...svg.children].map((part) => part.getBBox()).filter((part) => part.width + part.height > 0);
        return {count: svg.children.length, bytes: svg.outerHTML.length, isHidden: svg.getAttribute('aria-hidden'), classes: [...new Set([...svg.children].map((part) => part.getAttribute('class')))],
                low: Math.min(...box.flatMap((part) => [part.x, part.y])), right: Math.max(...box.map((part) => part.x + part.width)), bottom: Math.max(...box.map((part) => part.y + part.height))};
      })()`);
      assert.ok(found.count > 0 && found.classes.includes('sk-rod') && found.isHidden === 'true', `${name}: ${JSON.stringify(found)}`);
      assert.ok(found.low >= 0 && found.right <= width && found.bottom <= height, `${name} is larger than its picture: ${JSON.stringify(found)}`);
      assert.ok(found.bytes < 40e3, `${name} has ${found.bytes} bytes`);
    }
  await on.page.evaluate(() => { for (const svg of document.querySelectorAll('#small svg')) svg.setAttribute('fill', 'none'); });
  await on.page.screenshot({path: join(folder, 'scene-sketches.png'), fullPage: true});
  await on.page.evaluate(() => document.getElementById('small').replaceChildren());
  await on.done();
}

/** Without WebGL there is a word about it, and the same interface. */
async function plain(browser, url) {
  const on = await stand(browser, url, {width: 670, height: 544});
  await on.draw('3pfs-g2');
  assert.equal(await on.get('picture.canvas.tagName.toLowerCase()'), 'svg');
  assert.equal(await on.page.locator('.simplified').innerText(), '3-D simplified: no WebGL');
  await on.done();
}

const both = {robots, parts, tendons, cameras, names, hand, saved, scale}, wanted = process.argv.slice(5), {server, url: to} = await serve(), {server: own, url} = await bench(to);
const long = ['robots', 'parts', 'cameras', 'scale', 'speed', 'slow'];  // thoroughly, or asked for by name
const suites = {webgl: {...both, lookout, fingers, places, rest, speed, slow, sketches}, svg: {plain, ...both}};
try {
  for (const [kind, cases] of Object.entries(suites)) {
    const browser = await launch({hasWebGL: kind === 'webgl'});
    try {
      for (const [name, run] of Object.entries(cases)) {
        if (wanted.length > 0 ? !wanted.includes(name) : long.includes(name) && !isThorough) continue;
        const begin = performance.now();
        await run(browser, url, kind).catch((error) => { throw new Error(`${name} by ${kind}: ${error.message}`, {cause: error}); });
        console.log(`${name} by ${kind}: ${((performance.now() - begin) / 1000).toFixed(1)} s`);
      }
    } finally {
      await browser.close();
    }
  }
} finally {
  own.close();
  own.closeAllConnections();
  server.kill('SIGINT');
}
