// The command that gives the numbers of the page.
import type {Described} from './rows';

const short = (value: number) => String(Number(value.toPrecision(12)));

export function command(robot: string, described: Described, values: number[], load: number[]): string {
  const wrench = load.some((part) => part !== 0) ? ` --wrench "${load.map(short).join(', ')}"` : '';
  if (!described.isSerial) return `sinew forward ${robot} --inputs "${values.map(short).join(', ')}"${wrench}`;
  const sections: string[][] = [];
  described.rows.forEach((row, i) => {
    const index = Number(/\[(\d+)\]/.exec(row.name)?.[1] ?? 0);
    (sections[index] ??= []).push(short(values[i]!));
  });
  return `sinew forward ${robot} --configuration "${sections.map((pair) => pair.join(', ')).join('; ')}"`;
}
