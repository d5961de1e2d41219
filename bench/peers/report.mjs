// The record, bench/peers.json, and what is made of it: the tables of docs/cost.md and the line in README.md.
import { readFileSync, writeFileSync } from 'node:fs';
import { kPeers, kWorks } from './works.mjs';

const kBegin = '<!-- peers: -->', kEnd = '<!-- :peers -->';
const pair = (gpu) => `${gpu.instructions} / ${gpu.inverse_throughput}`;

/** Those that were there: MaterialX is not on npm. */
const measuredPeers = ({ versions }) => kPeers.filter(({ package: name }) => name in versions);

/** The fewest of each number among the peers that draw all of the work, on navi21; null where none does. */
function best(work, results) {
  const complete = kPeers.filter(({ leavesOut }) => !leavesOut[work.file]);
  const all = complete.map(({ name }) => results[name]?.navi21).filter(Boolean);
  if (all.length === 0) return null;
  const least = (what) => Math.min(...all.map((gpu) => gpu[what]));
  return { instructions: least('instructions'), inverse_throughput: least('inverse_throughput') };
}

/** The record as it is written: versions, and for each work the best, our sizes and what each peer needs. */
export function record({ versions, driver, device, results, ours }) {
  const works = {};
  for (const work of kWorks) {
    works[work.name] = { best: best(work, results[work.name]), ours: ours[work.name], peers: results[work.name] };
  }
  return { driver, device, versions, works };
}

function table(head, rows) {
  const [first, ...others] = [head, ...rows].map((row) => `| ${row.join(' | ')} |`);
  return [first, `|${'---|'.repeat(head.length)}`, ...others].join('\n');
}

function costTable(record, ours) {
  const peers = measuredPeers(record);
  const cell = (work, peer) => {
    const got = record.works[work.name].peers[peer.name];
    if (!got) return 'failed';
    return peer.leavesOut[work.file] ? `(${pair(got.navi21)})` : pair(got.navi21);
  };
  return table(['work', 'Lacquer', ...peers.map(({ title }) => title), 'Lacquer to the best'], kWorks.map((work) => {
    const own = ours[work.name], least = record.works[work.name].best;
    const percent = (what) => `${Math.round((100 * own[what]) / least[what])} %`;
    return [work.name, `**${pair(own)}**`, ...peers.map((peer) => cell(work, peer)),
      least ? `${percent('instructions')} / ${percent('inverse_throughput')}` : 'none does it'];
  }));
}

const shownSize = ({ bytes, driver_ms }) => `${(bytes / 1000).toFixed(1)} / ${driver_ms.toFixed(1)}`;
const shownTime = ({ fragment_ns }) => (fragment_ns < 100 ? fragment_ns.toFixed(1) : fragment_ns.toFixed(0));

function ownTable(record, shown) {
  const peers = measuredPeers(record);
  const cell = (work, peer) => {
    const got = record.works[work.name].peers[peer.name];
    if (!got) return 'failed';
    return peer.leavesOut[work.file] ? `(${shown(got)})` : shown(got);
  };
  return table(['work', 'Lacquer', ...peers.map(({ title }) => title)], kWorks.map((work) => {
    return [work.name, `**${shown(record.works[work.name].ours)}**`, ...peers.map((peer) => cell(work, peer))];
  }));
}

function colorTable(record) {
  const peers = measuredPeers(record);
  const drawn = kWorks.filter(({ name, ibl }) => ibl && Object.values(record.works[name].peers).some(({ colors }) => colors));
  const cell = (work, peer) => {
    const colors = record.works[work.name].peers[peer.name]?.colors;
    if (!colors) return 'failed';
    const text = `${colors.mean} / ${colors.max}`;
    return peer.leavesOut[work.file] ? `(${text})` : text;
  };
  return table(['work', 'mean of ours', ...peers.map(({ title }) => title)], drawn.map((work) => {
    const any = Object.values(record.works[work.name].peers).find(({ colors }) => colors);
    return [work.name, any.colors.mean_of_ours, ...peers.map((peer) => cell(work, peer))];
  }));
}

function peerTable(record) {
  const leftOut = ({ leavesOut }) => {
    const each = Object.entries(leavesOut).map(([file, what]) => `of ${file.toUpperCase()}: ${what}`);
    return each.join('; ') || 'nothing';
  };
  return table(['peer', 'version', 'leaves out', 'does differently'],
    measuredPeers(record).map((peer) => [peer.title, record.versions[peer.package], leftOut(peer), peer.differs]));
}

/** What stands between the marks of docs/cost.md. */
export function section(record, ours) {
  return `
${record.driver}, navi21, instructions / inverse throughput, in brackets what is not the whole work:

${costTable(record, ours)}

Kilobytes of the fragment stage's SPIR-V without names / milliseconds of processor time in which the driver makes a
pipeline of it:

${ownTable(record, shownSize)}

Nanoseconds of processor time that a fragment takes on ${record.device}:

${ownTable(record, shownTime)}

${peerTable(record)}

How far their colours are from ours with image-based light, in linear RGB, mean / largest of all channels and pixels (\`bench/peers.json\` has
all works):

${colorTable(record)}
`;
}

/** The four works of the README: ours in hundredths of the best peer's instructions. */
function line(record, ours) {
  const percents = ['W0', 'W1', 'W2', 'W3'].map((name) => {
    return Math.round((100 * ours[name].instructions) / record.works[name].best.instructions);
  });
  const titled = ({ title, package: name }) => `${title.replace(/ \(.*\)/, '')} ${record.versions[name]}`;
  const versions = [...new Set(measuredPeers(record).map(titled))];
  return `${percents.slice(0, 3).join(', ')} and ${percents[3]} % of the fewest instructions that the ` +
    `${versions.slice(0, -1).join(', ')} or ${versions.at(-1)} need for the same work`;
}

/** What a page holds, with what stands between its marks replaced. */
function renewed(path, text) {
  const old = readFileSync(path, 'utf8');
  const begin = old.indexOf(kBegin), end = old.indexOf(kEnd);
  if (begin < 0 || end < begin) throw new Error(`${path} has no ${kBegin} and ${kEnd}`);
  return old.slice(0, begin + kBegin.length) + text + old.slice(end);
}

/** The pages as the records in bench/ say, by path; theirs are in peers.json, ours in cost.json. */
export function pages(root) {
  const read = (name) => JSON.parse(readFileSync(`${root}/bench/${name}`, 'utf8'));
  const theirs = read('peers.json'), cost = read('cost.json');
  const ours = Object.fromEntries(kWorks.map(({ name }) => [name, cost.works[name].multiple_scattering.direct.navi21]));
  return {
    [`${root}/docs/cost.md`]: renewed(`${root}/docs/cost.md`, section(theirs, ours)),
    [`${root}/README.md`]: renewed(`${root}/README.md`, line(theirs, ours)),
  };
}

export function writeRecord(root, measured) {
  writeFileSync(`${root}/bench/peers.json`, `${JSON.stringify(record(measured), null, 2)}\n`);
}

export function writePages(root) {
  for (const [path, text] of Object.entries(pages(root))) writeFileSync(path, text);
}
