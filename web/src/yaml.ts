// Numbers and words of a robot's file by their paths, as `--set` writes them: what of it was changed, and changing it.
import {yamlLanguage} from '@codemirror/lang-yaml';
import type {SyntaxNode} from '@lezer/common';

/** A path, and what is written there. */
export type Change = [path: string, value: string];

interface Scalar { from: number; to: number; text: string }

function childrenOf(node: SyntaxNode, name: string): SyntaxNode[] {
  return node.getChildren(name);
}

const lists = ['BlockSequence', 'FlowSequence'], mappings = ['BlockMapping', 'FlowMapping'], scalars = ['Literal', 'QuotedLiteral'];

/** Null where the file has what this reads not: anchors, blocks of text, errors. */
function scalarsOf(text: string): Map<string, Scalar> | null {
  const found = new Map<string, Scalar>();
  const read = (node: SyntaxNode): string => {
    const raw = text.slice(node.from, node.to);
    return node.name === 'QuotedLiteral' ? raw.slice(1, -1) : raw.replace(/\s+/g, ' ');
  };
  const walk = (node: SyntaxNode, path: string): boolean => {
    if (scalars.includes(node.name)) {
      if (found.has(path)) return false;
      found.set(path, {from: node.from, to: node.to, text: read(node)});
      return true;
    }
    if (lists.includes(node.name)) return childrenOf(node, 'Item').every((item, i) => !!item.firstChild && walk(item.firstChild, `${path}[${i}]`));
    if (!mappings.includes(node.name)) return false;
    return childrenOf(node, 'Pair').every((pair) => {
      const key = pair.getChild('Key')?.firstChild, value = pair.lastChild;
      return !!key && !!value && /^[\w-]+$/.test(read(key)) && value.name !== ':' && value.name !== 'Key' && walk(value, path ? `${path}.${read(key)}` : read(key));
    });
  };
  const {topNode} = yamlLanguage.parser.parse(text), documents = topNode.getChildren('Document'), roots = documents.flatMap((one) => childrenOf(one, 'BlockMapping'));
  let isWhole = documents.length === 1 && roots.length === 1;
  topNode.cursor().iterate((node) => { if (node.type.isError) isWhole = false; });
  return isWhole && walk(roots[0]!, '') ? found : null;
}

/** What was changed, as far as it is values of what was there before; null where it is more. */
export function changesOf(before: string, after: string): Change[] | null {
  const [was, is] = [scalarsOf(before), scalarsOf(after)];
  if (!was || !is || was.size !== is.size) return null;
  const changes: Change[] = [];
  for (const [path, {text}] of is) {
    const old = was.get(path);
    if (!old) return null;
    if (old.text !== text) changes.push([path, text]);
  }
  return changes;
}

/** The file with these values in it; null where it has no such places. */
export function withChanges(text: string, changes: Change[]): string | null {
  const places = scalarsOf(text), edits: {from: number; to: number; value: string}[] = [];
  for (const [path, value] of changes) {
    const place = places?.get(path);
    if (!place) return null;
    edits.push({from: place.from, to: place.to, value});
  }
  for (const {from, to, value} of edits.sort((a, b) => b.from - a.from)) text = text.slice(0, from) + value + text.slice(to);
  return text;
}
