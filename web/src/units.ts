// Answers are SI and radians; people read millimetres and degrees unless they ask for SI.

export type Unit = 'm' | 'rad' | 'N' | 'N m' | '1/m' | 'm/N' | 'N/m' | 'J' | '';
export type System = 'mm' | 'SI';

interface Shown { factor: number; name: string; digits: number }

const shown: Record<Unit, Record<System, Shown>> = {
  m: {mm: {factor: 1e3, name: 'mm', digits: 3}, SI: {factor: 1, name: 'm', digits: 6}},
  rad: {mm: {factor: 180 / Math.PI, name: 'deg', digits: 2}, SI: {factor: 1, name: 'rad', digits: 5}},
  N: {mm: {factor: 1, name: 'N', digits: 3}, SI: {factor: 1, name: 'N', digits: 3}},
  'N m': {mm: {factor: 1, name: 'N m', digits: 4}, SI: {factor: 1, name: 'N m', digits: 4}},
  '1/m': {mm: {factor: 1, name: '1/m', digits: 3}, SI: {factor: 1, name: '1/m', digits: 3}},
  'm/N': {mm: {factor: 1e3, name: 'mm/N', digits: 2}, SI: {factor: 1, name: 'm/N', digits: 5}},
  'N/m': {mm: {factor: 1, name: 'N/m', digits: 3}, SI: {factor: 1, name: 'N/m', digits: 3}},
  J: {mm: {factor: 1, name: 'J', digits: 4}, SI: {factor: 1, name: 'J', digits: 4}},
  '': {mm: {factor: 1, name: '', digits: 5}, SI: {factor: 1, name: '', digits: 5}},
};

/** Words of a number box, with the SI value of one of them. */
const written: Record<string, [Unit, number]> = {
  m: ['m', 1], mm: ['m', 1e-3], cm: ['m', 1e-2], um: ['m', 1e-6], in: ['m', 0.0254],
  N: ['N', 1], mN: ['N', 1e-3], kN: ['N', 1e3], 'N m': ['N m', 1], 'N mm': ['N m', 1e-3],
  rad: ['rad', 1], deg: ['rad', Math.PI / 180], '°': ['rad', Math.PI / 180],
};

const kinds: Record<Unit, string> =
  {m: 'length', rad: 'angle', N: 'force', 'N m': 'moment', '1/m': 'curvature', 'm/N': 'compliance', 'N/m': 'force per length', J: 'energy', '': 'this number'};

export function unitName(unit: Unit, system: System): string {
  return shown[unit][system].name;
}

/** The number in the unit that is shown. */
export const shownValue = (value: number, unit: Unit, system: System): number => value * shown[unit][system].factor;

/** The number alone, as it is shown. */
export function format(value: number, unit: Unit, system: System): string {
  const how = shown[unit][system];
  const text = (value * how.factor).toFixed(how.digits);
  return /^-0\.?0*$/.test(text) ? text.slice(1) : text;
}

function number(text: string): number {
  const fraction = /^([+-]?\d+)\s*\/\s*(\d+)$/.exec(text);
  if (fraction) return Number(fraction[1]) / Number(fraction[2]);
  return text === '' ? NaN : Number(text);
}

/** The SI value of `12`, `12 mm`, `0.012 m`, `1/2 in`; or why it is none. A bare number has the unit that is shown. */
export function parse(text: string, unit: Unit, system: System): number | string {
  const parts = /^\s*(.*?)\s*([a-z°]*(?: m{1,2})?)\s*$/i.exec(text);
  const value = number(parts?.[1] ?? '');
  if (!Number.isFinite(value)) return `${text.trim() || 'nothing'} is no number`;
  const word = parts?.[2] ?? '';
  if (word === '') return value / shown[unit][system].factor;
  const found = written[word];
  if (!found) return `${word} is no unit; write ${unitName(unit, system) || 'a number alone'}`;
  if (found[0] !== unit) return `${word} is no unit of ${kinds[unit]}`;
  return value * found[1];
}
