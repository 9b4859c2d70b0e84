// A stand-in for a server with a device, for how states look: it tells frames that a test gives it, keeps what the page asks of the
// device, and passes all else on to a real server. The rules of a lease are the simplest that the page can live with.
import {createServer, request} from 'node:http';

const usual = {source: 'demo', name: '/dev/stand-in', file: '', sections: 5, tendons: 3, has_tension: true, tension_limit: 20, has_stage: true, stage_limit: 0.15, faults: true};

/** @param robot the file that the server says it was started with */
export async function standIn(url, robot, text, info = {}, port = 0) {
  const said = [], refusals = {}, listeners = new Set(), entries = [];
  let last = null, lease = null, number = 6, plan = null, plans = 0;
  const send = (response, event, data) => response.write(`event: ${event}\ndata: ${JSON.stringify(data)}\n\n`);
  const reply = (response, status, json) => {
    response.writeHead(status, {'Content-Type': 'application/json', 'Cache-Control': 'no-store'});
    response.end(JSON.stringify(json));
  };
  /** What a frame says of the plan. */
  const atStep = (place, more = {}) => ({name: plan.name, number: plan.number, step: Math.floor(place), of: plan.steps.length - 1, fraction: place % 1, clearance: plan.clearance?.[Math.floor(place)] ?? null, off_path: null, done: place === plan.steps.length - 1, ...more});
  const control = () => ({holder: lease ? number : null, since: '10:41'});

  function command(call, body, response) {
    said.push({call, body});
    const {isOnce, ...error} = refusals[call] ?? {};
    if (isOnce) delete refusals[call];
    if (error.code) return reply(response, 409, {error});
    if (call === 'lease' && body.lease && body.lease !== lease) return reply(response, 409, {error: {code: 'not_yours', message: 'this lease is over; take control again'}});
    if (call === 'lease') {
      if (!lease) lease = `secret-${++number}`;
      if (last) push({...last, control: control(), state: last.state === 'view_only' ? 'control' : last.state});
      return reply(response, 200, {lease, number});
    }
    if (call === 'release') lease = null;
    if (call === 'plan') {
      plan = body.steps ? {name: body.name, number: ++plans, steps: body.steps, clearance: body.clearance ?? null} : null;
      if (last) push({...last, plan: plan && atStep(0)});
    }
    if (call === 'arm' && last) push({...last, state: 'armed', armed_left: 60});
    if (call === 'disarm' && last) push({...last, state: 'control', armed_left: 0, why: 'you disarmed'});
    if (call === 'release' && last) push({...last, control: control(), state: 'view_only'});
    reply(response, 200, {});
  }

  function device(path, incoming, response) {
    if (path === '') return reply(response, 200, {device: {...usual, robot: '', ...info}});
    if (path === 'events') {
      response.writeHead(200, {'Content-Type': 'text/event-stream', 'Cache-Control': 'no-store'});
      response.flushHeaders();
      for (const entry of entries) send(response, 'log', entry);
      if (last) send(response, 'frame', last);
      listeners.add(response);
      return response.on('close', () => listeners.delete(response));
    }
    if (path === 'plan' && incoming.method === 'GET') return reply(response, 200, {plan});
    if (path === 'snapshot') {
      let bytes = 0;
      incoming.on('data', (part) => { bytes += part.length; });
      return void incoming.on('end', () => {
        said.push({call: path, body: {text: new URL(incoming.url, url).searchParams.get('text'), type: incoming.headers['content-type'], bytes}});
        if (refusals[path]) return reply(response, 409, {error: refusals[path]});
        reply(response, 200, {name: 'recorded-001.jpg'});
      });
    }
    let body = '';
    incoming.on('data', (part) => { body += part; });
    incoming.on('end', () => command(path, JSON.parse(body), response));
  }

  function pass(incoming, response) {
    const {host, port} = new URL(url), headers = {...incoming.headers, host, ...(incoming.headers.origin && {origin: new URL(url).origin})};
    const onward = request({host: '127.0.0.1', port, path: incoming.url, method: incoming.method, headers, agent: false}, (answer) => {
      response.writeHead(answer.statusCode, answer.headers);
      answer.pipe(response);
    });
    onward.on('error', () => response.destroy());
    incoming.pipe(onward);
  }

  /** The newest frame, to all that listen. */
  function push(frame) {
    last = frame;
    for (const one of listeners) send(one, 'frame', frame);
  }

  const server = createServer((incoming, response) => {
    const {pathname} = new URL(incoming.url, url), [, path] = /^\/api\/device\/?(.*)$/.exec(pathname) ?? [];
    if (path !== undefined) return device(path, incoming, response);
    if (pathname === '/api/robots') return void fetch(new URL(pathname, url)).then((answer) => answer.json()).then((json) => reply(response, 200, {...json, opened: {name: robot, text}}));
    pass(incoming, response);
  });
  await new Promise((done) => server.listen(port, '127.0.0.1', done));
  server.unref();
  return {
    url: `http://127.0.0.1:${server.address().port}/`, said, refusals, push, control, atStep,
    get frame() { return last; },
    get plan() { return plan; },
    get isTaken() { return lease !== null; },
    /** By another page. */
    takenElsewhere() { [lease, number] = ['elsewhere', 3]; },
    /** As the server does after 2 s: what a closing page says last may never arrive. */
    forgetLease() {
      lease = null;
      if (last) push({...last, control: control(), state: 'view_only'});
    },
    log(entry) {
      entries.push(entry);
      for (const one of listeners) send(one, 'log', entry);
    },
    calls: (name) => said.filter(({call}) => call === name),
    close() {
      for (const one of listeners) one.destroy();
      server.closeAllConnections?.();
      server.close();
    },
  };
}

const ask = async (url, robot, queries) => (await fetch(new URL(`/api/query?robot=${robot}`, url), {method: 'POST', body: JSON.stringify(queries), headers: {'Content-Type': 'application/json'}})).json();

/** Makes frames of a robot: the sections as `diagram` has them, the rest as of a device at rest. */
export async function framer(url, text) {
  const {robot} = await (await fetch(new URL('/api/robot', url), {method: 'POST', body: text, headers: {'Content-Type': 'text/yaml'}})).json();
  const [{sections}] = await ask(url, robot, [{query: 'describe'}]);
  /** @param bends of the sections @param slack of each, beyond what they need; or changes as they are */
  return async (bends, slack, {more = {}, each = () => ({}), changes: given, model = 'lsk'} = {}) => {
    const polar = ([x, y], i) => (sections[i].type === 'tpcj' ? [x, y] : [Math.hypot(x, y), Math.atan2(y, x)]);
    const [forward] = await ask(url, robot, [{query: 'forward', configuration: bends.map(polar), model, ...(slack && {slack})}]), changes = given?.(forward.changes) ?? forward.changes;
    const diagrams = await ask(url, robot, sections.map((_, section) => ({query: 'diagram', section, model, changes: changes.slice(0, section + 1)})));
    const told = diagrams.map((one, i) => ({
      ...one, locked: false, commanded: one.point, target: one.point, measured: one.point, changes: changes[i], set: changes[i],
      tension: changes[i].map((_, k) => 2 + 0.7 * k + 0.3 * i), ...each(i, one),
    }));
    return {
      time: 100, age: 0.01, link: 'ok', message: '', round_trip: 0.008, rate: 50, errors: 0, control: {holder: null, since: ''}, state: 'view_only', activity: 'rest', armed_left: 0, why: '', homed: true,
      homing: null, stage: 0.1175, insertion: 0.1175, stage_target: 0.12, speed: 0.002, recording: null, tip: forward.tip.position, sections: told, alarm: null, ...more,
    };
  };
}
