// A recording as one page to keep or to print: it needs no server, no script and nothing beside it. All of it is made as
// elements, so that whatever a text holds stays a text.
import {make} from '../make';
import {type Json, Lost} from '../client';
import {amount} from './banner';
import {isPolar, limitOf} from './coordinates';
import {Diagram, given} from './diagram';
import {kindOf, kindOfEntry, kinds, type SectionFrame} from './frame';
import {icon} from './mark';
import type {Recording, Stretch} from './recording';
import {picture} from './recordings';
import {diagramQuery} from './replay';
import {chart, type Line} from './report_curves';
import type {Opened} from './subject';

const words = ['EXACT', 'PARTLY SLACK', 'SLACK', 'UNREACHABLE', 'NO DATA', 'OVER-TENSIONED'];
const most = {alarms: 40, events: 2000, pictures: 60};
const side = 190;  // of a diagram [px]
const degrees = 180 / Math.PI;

type Cell = Node | string;
const table = (head: string[], rows: Cell[][], looks = ''): HTMLElement => make('table', {className: looks}, make('thead', {}, make('tr', {}, ...head.map((textContent) => make('th', {textContent})))), make('tbody', {}, ...rows.map((row) => make('tr', {}, ...row.map((cell) => make('td', {}, cell))))));
const seconds = (value: number) => `${value.toFixed(2)} s`;
const left = (count: number, of: string) => (count > 0 ? [make('p', {className: 'note', textContent: `${count} more ${of} are in the recording.`})] : []);

/** Rules of the page's own style, by day, for what is drawn as on the page. */
function looks(): string {
  const rules = [...document.styleSheets].flatMap((sheet) => [...sheet.cssRules]).filter((rule): rule is CSSStyleRule => rule instanceof CSSStyleRule);
  const isDrawn = ({selectorText}: CSSStyleRule) => /(^|[\s,])\.(diagram|frontier|mark-of|tag|icon)\b/.test(selectorText) && !/dark|section/.test(selectorText);
  return [rules.find(({selectorText}) => selectorText === ':root')!, ...rules.filter(isDrawn)].map(({cssText}) => cssText).join('\n') + own;
}

const own = `
body { font: 13px/1.45 system-ui, sans-serif; color: var(--text); background: #fff; max-width: 780px; margin: 24px auto; padding: 0 16px; }
h1 { font-size: 21px; margin: 0 0 8px; } h2 { font-size: 15px; margin: 28px 0 8px; border-bottom: 1px solid var(--line); } h3 { font-size: 13px; margin: 14px 0 2px; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; } th { text-align: left; color: var(--mute); font-weight: 600; } th, td { padding: 3px 10px 3px 0; border-bottom: 1px solid var(--line); vertical-align: top; }
table.facts { width: auto; } .facts td:first-child { color: var(--mute); } p { margin: 4px 0; } .note { color: var(--mute); } .word { display: inline-flex; gap: 6px; align-items: center; white-space: nowrap; }
.alarms { display: grid; grid-template-columns: repeat(auto-fill, minmax(230px, 1fr)); gap: 16px; } figure { margin: 0; break-inside: avoid; } figcaption { overflow-wrap: anywhere; } .alarms strong { display: block; }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(230px, 1fr)); gap: 16px; } img { max-width: 100%; display: block; }
.chart { display: block; width: 100%; height: auto; break-inside: avoid; } .chart .grid { stroke: var(--line); stroke-width: 0.5; } .chart .box { fill: none; stroke: var(--mute); } .chart .tick { font-size: 11px; fill: var(--mute); }
.curve { fill: none; stroke-width: 1.5; stroke-linejoin: round; stroke: var(--tendon-1); } .curve.second { stroke: var(--section-5); } .curve.t-1 { stroke: var(--tendon-1); } .curve.t-2 { stroke: var(--tendon-2); stroke-dasharray: 8 4; } .curve.t-3 { stroke: var(--tendon-3); stroke-dasharray: 2 4; } .curve.t-4 { stroke: var(--tendon-4); stroke-dasharray: 10 3 2 3; }
.curve.set { stroke-width: 1; stroke-dasharray: 4 3; } .band { opacity: 0.16; fill: var(--slack-fill); } .band.over { fill: var(--over); } .band.unreachable { fill: var(--unreachable); } .band.stale { fill: var(--stale); }
pre { white-space: pre-wrap; overflow-wrap: anywhere; font-size: 11px; background: var(--panel); padding: 8px; }
@media print { body { margin: 0; max-width: none; } h2 { break-after: avoid; } tr { break-inside: avoid; } * { print-color-adjust: exact; } }
`;

const stateWord = (word: string) => make('span', {className: 'word'}, icon(kindOf(word), 14), word);

function facts(recording: Recording): HTMLElement {
  const worst = recording.stretches.reduce((found, {word}) => (kinds.indexOf(kindOf(word)) > kinds.indexOf(kindOf(found)) ? word : found), 'EXACT');
  const rows: Cell[][] = [['Robot', recording.robot], ['Table of the controller', recording.table], ['Model', recording.model], ['Begun', recording.date], ['Lasted', seconds(recording.duration)], ['Measurements', String(recording.rows)], ['Worst state', stateWord(worst)]];
  if (recording.tensionLimit > 0) rows.push(['Limit of tensions', `${recording.tensionLimit} N`]);
  if (recording.leftOut > 0) rows.push(['Lines left out', `${recording.leftOut}: ${recording.wrong[0] ?? ''}`]);
  return table([], rows, 'facts');
}

/** How long each section was in each state. */
function states({sections, stretches, duration}: Recording): HTMLElement {
  const present = words.filter((one) => stretches.some(({word}) => word === one)), lasted = (section: number, of: string) => stretches.reduce((sum, {section: own, word, from, to}) => sum + (own === section && word === of ? to - from : 0), 0);
  return table(['Section', ...present], Array.from({length: sections}, (_, i) => [`S${i + 1}`, ...present.map((word) => `${seconds(lasted(i, word))} (${((100 * lasted(i, word)) / Math.max(duration, 1e-9)).toFixed(0)} %)`)]));
}

/** The log's own words for it, else its word. */
function sentence(recording: Recording, stretch: Stretch, frame: SectionFrame | null): string {
  return recording.said(stretch) || `S${stretch.section + 1} ${stretch.word}${frame ? amount({...frame, word: stretch.word}, 'mm') : ''}`;
}

async function alarms({robot, described}: Opened, recording: Recording): Promise<Node[]> {
  const {sections} = described.answer, all = recording.alarms, shown = all.slice(0, most.alarms), rows = shown.map(({from}) => recording.rowAt(from));
  if (all.length === 0) return [make('p', {textContent: 'There was none.'})];
  const asked = shown.map(({section}, i) => (recording.isHomed(rows[i]!) ? diagramQuery(recording, sections, rows[i]!, section) : {query: 'describe'}));
  const answers = await robot.ask(asked) as Json[];
  const drawn = shown.map((alarm, i) => {
    const {section, word, from, to} = alarm, answer = answers[i]!, lasted = `${recording.clock(from)}, at ${seconds(from)}, for ${seconds(to - from)}${to >= recording.duration ? ', until its end' : ''}`;
    const frame: SectionFrame | null = answer.class ? {...answer, word, target: recording.bend(rows[i]!, section, 'beta'), measured: recording.bend(rows[i]!, section, 'measured_beta'), changes: recording.ofTendons(rows[i]!, section, 'change')} : null;
    const caption = make('figcaption', {}, make('strong', {textContent: sentence(recording, alarm, frame)}), lasted);
    if (!frame || kindOf(word) === 'stale') return make('figure', {}, stateWord(word), caption);
    const diagram = new Diagram();
    diagram.draw({section: frame, kind: kindOf(word), isDisc: isPolar(sections[section]), limit: frame.envelope?.limit ?? limitOf(sections[section]), trail: [], given: given(frame, section), over: null}, side);
    return make('figure', {}, diagram.element, caption);
  });
  return [make('div', {className: 'alarms'}, ...drawn), ...left(all.length - shown.length, 'alarms')];
}

const turned = (values: Float64Array) => values.map((value) => value * degrees);

function curves({described}: Opened, recording: Recording): Node[] {
  const {times, gaps, duration, alarms: bad} = recording, nodes: Node[] = [], bands = (section: number | null) => bad.filter((one) => one.section === section).map(({word, from, to}) => ({from, to, looks: kindOf(word)}));
  const add = (title: string, note: string, lines: Line[], section: number | null) => {
    const drawn = chart(title, times, gaps, lines, duration, bands(section));
    if (drawn) nodes.push(make('section', {}, make('h3', {textContent: title}), make('p', {className: 'note', textContent: note}), drawn));
  };
  for (let m = 0; m < recording.sections; ++m) {
    const names = isPolar(described.answer.sections[m]) ? ['θ cos φ', 'θ sin φ'] : ['β₁', 'β₂'];
    add(`Bends of S${m + 1} [deg]`, `${names[0]} blue, ${names[1]} brown; dashed: set`, names.flatMap((name, i): Line[] => [
      {name, values: turned(recording.column(`S${m}_measured_beta_${i + 1}`)), looks: i === 0 ? '' : 'second'}, {name, values: turned(recording.column(`S${m}_beta_${i + 1}`)), looks: `set ${i === 0 ? '' : 'second'}`}]), m);
  }
  add('Stage [mm]', 'dashed: set', [{name: 'measured', values: recording.column('measured_stage').map((value) => 1e3 * value), looks: ''}, {name: 'set', values: recording.column('stage').map((value) => 1e3 * value), looks: 'set'}], null);
  for (let m = 0; m < recording.sections; ++m)
    add(`Tensions of S${m + 1} [N]`, Array.from({length: recording.tendons}, (_, i) => `${i + 1} ${['solid', 'dashed', 'dotted', 'dash and dot'][i % 4]}`).join(', '), Array.from({length: recording.tendons}, (_, i) => ({name: String(i + 1), values: recording.column(`S${m}_tension_${i + 1}`), looks: `t-${(i % 4) + 1}`})), m);
  return nodes;
}

const asData = (blob: Blob): Promise<string> => new Promise((done, failed) => {
  const reader = new FileReader();
  reader.onload = () => done(String(reader.result));
  reader.onerror = () => failed(reader.error);
  reader.readAsDataURL(blob);
});

/** @param name of the recording on the server; empty: pictures are elsewhere */
async function pictures(recording: Recording, name: string): Promise<Node[]> {
  const all = recording.events.filter(({picture: number}) => number), shown = all.slice(0, most.pictures), nodes: Node[] = [];
  if (all.length === 0) return [make('p', {textContent: 'There is none.'})];
  for (const {picture: number, text, clock, time} of shown) {
    const blob = name ? await picture(name, number).catch((error) => { if (error instanceof Lost) throw error; return null; }) : null;
    nodes.push(make('figure', {}, ...(blob ? [make('img', {src: await asData(blob), alt: text})] : [make('p', {className: 'note', textContent: 'its file is not here'})]), make('figcaption', {textContent: `${clock}, at ${seconds(time)}: ${text}`})));
  }
  return [make('div', {className: 'pictures'}, ...nodes), ...left(all.length - shown.length, 'snapshots')];
}

/** @param name of the recording on the server, for its pictures; empty: it is a file from elsewhere */
export async function reportOf(opened: Opened, recording: Recording, name: string): Promise<string> {
  const page = document.implementation.createHTMLDocument(`${recording.name} – report`), {events} = recording, part = (title: string, ...nodes: Node[]) => page.body.append(make('h2', {textContent: title}), ...nodes);
  page.documentElement.lang = 'en';
  page.head.prepend(make('meta', {httpEquiv: 'Content-Security-Policy', content: "default-src 'none'; img-src data:; style-src 'unsafe-inline'"}));
  page.head.prepend(make('meta', {name: 'viewport', content: 'width=device-width, initial-scale=1'}));
  const encoding = make('meta');
  encoding.setAttribute('charset', 'utf-8');
  page.head.prepend(encoding);
  page.body.append(make('h1', {textContent: `Recording of ${recording.robot}`}), facts(recording));
  part('Time in each state', states(recording));
  part('Alarms', ...await alarms(opened, recording));
  part('Curves', make('p', {className: 'note', textContent: 'Shaded: this section was not exact. Where measurements are missing a line is broken.'}), ...curves(opened, recording));
  part('Snapshots', ...await pictures(recording, name));
  part('Events', table(['Time', 'At', '', 'Event'], events.slice(0, most.events).map(({clock, time, kind, text}) => [clock, seconds(time), kindOfEntry(kind) ? icon(kindOfEntry(kind)!, 14) : '', text])), ...left(events.length - most.events, 'events'));
  part('Robot', make('pre', {textContent: recording.text}));
  // As an element a style would have to keep this page's policy. Texts have no `<`: the first `</head>` is that of the head.
  return `<!doctype html>\n${page.documentElement.outerHTML.replace('</head>', () => `<style>${looks()}</style></head>`)}\n`;
}
