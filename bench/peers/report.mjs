// The record, bench/peers.json, and what is made of it: the tables of docs/cost.md and the line in README.md.
import { readFileSync, writeFileSync } from 'node:fs';
import { kPeers, kWorks } from './works.mjs';

const kBegin = '<!-- peers: -->', kEnd = '<!-- :peers -->';
const pair = (gpu) => `${gpu.instructions} / ${gpu.inverse_throughput}`;

/** The fewest of each number among the peers that draw all of the work, on navi21; null where none does. */
function best(work, results) {
  const all = kPeers.filter(({ leavesOut }) => !leavesOut[work.file]).map(({ name }) => results[name]?.navi21).filter(Boolean);
  if (all.length === 0) return null;
  const least = (what) => Math.min(...all.map((gpu) => gpu[what]));
  return { instructions: least('instructions'), inverse_throughput: least('inverse_throughput') };
}

/** The record as it is written: versions, and for each work the best and what each peer needs. */
export function record({ versions, driver, results }) {
  const works = {};
  for (const work of kWorks) works[work.name] = { best: best(work, results[work.name]), peers: results[work.name] };
  return { driver, versions, works };
}

function table(head, rows) {
  const [first, ...others] = [head, ...rows].map((row) => `| ${row.join(' | ')} |`);
  return [first, `|${'---|'.repeat(head.length)}`, ...others].join('\n');
}

function costTable(record, ours) {
  const cell = (work, peer) => {
    const got = record.works[work.name].peers[peer.name];
    if (!got) return 'failed';
    return peer.leavesOut[work.file] ? `(${pair(got.navi21)})` : pair(got.navi21);
  };
  return table(['work', 'Lacquer', ...kPeers.map(({ title }) => title), 'Lacquer to the best'], kWorks.map((work) => {
    const own = ours[work.name], least = record.works[work.name].best;
    const percent = (what) => `${Math.round((100 * own[what]) / least[what])} %`;
    return [work.name, `**${pair(own)}**`, ...kPeers.map((peer) => cell(work, peer)),
      least ? `${percent('instructions')} / ${percent('inverse_throughput')}` : 'none does it'];
  }));
}

function colorTable(record) {
  const drawn = kWorks.filter(({ name }) => Object.values(record.works[name].peers).some(({ colors }) => colors));
  const cell = (work, peer) => {
    const colors = record.works[work.name].peers[peer.name]?.colors;
    if (!colors) return 'failed';
    const text = `${colors.mean} / ${colors.max}`;
    return peer.leavesOut[work.file] ? `(${text})` : text;
  };
  return table(['work', 'mean of ours', ...kPeers.map(({ title }) => title)], drawn.map((work) => {
    const any = Object.values(record.works[work.name].peers).find(({ colors }) => colors);
    return [work.name, any.colors.mean_of_ours, ...kPeers.map((peer) => cell(work, peer))];
  }));
}

function peerTable(record) {
  const leftOut = ({ leavesOut }) => Object.entries(leavesOut).map(([file, what]) => `of ${file.toUpperCase()}: ${what}`).join('; ') || 'nothing';
  return table(['peer', 'version', 'leaves out', 'does differently'],
    kPeers.map((peer) => [peer.title, record.versions[peer.package], leftOut(peer), peer.differs]));
}

function page(record, ours) {
  return `${record.driver}, navi21, instructions / inverse throughput, in brackets what is not the whole work:

${costTable(record, ours)}

${peerTable(record)}

How far their colours are from ours, in linear RGB, mean / largest of all channels and pixels:

${colorTable(record)}
`;
}

/** Replaces what stands between the marks of a page. */
function renew(path, text) {
  const old = readFileSync(path, 'utf8');
  const begin = old.indexOf(kBegin), end = old.indexOf(kEnd);
  if (begin < 0 || end < begin) throw new Error(`${path} has no ${kBegin} and ${kEnd}`);
  writeFileSync(path, old.slice(0, begin + kBegin.length) + text + old.slice(end));
}

/** The four works of the README: ours in hundredths of the best peer's instructions. */
function line(record, ours) {
  const percents = ['W0', 'W1', 'W2', 'W3'].map((name) => Math.round((100 * ours[name].instructions) / record.works[name].best.instructions));
  const versions = [...new Set(kPeers.map((peer) => `${peer.title.replace(/ \((PBR|OpenPBR)\)/, '')} ${record.versions[peer.package]}`))];
  return `${percents.slice(0, 3).join(', ')} and ${percents[3]} % of the fewest instructions that the ${versions.slice(0, -1).join(', ')} or ` +
    `${versions.at(-1)} need for the same work`;
}

/** `root` is the tree, `measured` what peers.mjs found. Ours are those of bench/cost.json. */
export function write(root, measured) {
  const made = record(measured);
  const cost = JSON.parse(readFileSync(`${root}/bench/cost.json`, 'utf8'));
  if (cost.driver !== made.driver) console.error(`bench peers: ours were measured with ${cost.driver}, theirs with ${made.driver}: \`./dev bench cost\` renews ours`);
  const ours = Object.fromEntries(kWorks.map(({ name }) => [name, cost.works[name].multiple_scattering.direct.navi21]));
  writeFileSync(`${root}/bench/peers.json`, `${JSON.stringify(made, null, 2)}\n`);
  renew(`${root}/docs/cost.md`, `\n${page(made, ours)}`);
  renew(`${root}/README.md`, line(made, ours));
  return page(made, ours);
}
