// The gallery's record, bench/gallery.json, and its page, docs/gallery.md.
import { readFileSync, writeFileSync } from 'node:fs';
import { readGallery } from './gallery.mjs';
import { kSheetRows, sheetName } from './pictures.mjs';
import { kGalleryPeers } from './works.mjs';

const kAddress = '../build/web/view.html#open=gallery.gltf/';

const shownPeers = ({ versions }) => kGalleryPeers.filter(({ package: name }) => name in versions);

/** A peer's figures: mean / largest difference, and how much of the extension's effect is another one. */
function cell(got) {
  if (!got) return '';
  if (got.problem) return 'fails';
  if (got.knows === false) return `no · ${got.mean} / ${got.max}`;
  const percent = typeof got.effect_apart === 'number' ? `${Math.round(100 * got.effect_apart)} % · ` : '';
  return `${percent}${got.mean} / ${got.max}`;
}

const rowOf = (cells) => `| ${cells.join(' | ')} |`;

function sheetSection(record, entries, first) {
  const peers = shownPeers(record), here = entries.slice(first, first + kSheetRows);
  const head = ['material', 'mean of ours', ...peers.map(({ title }) => title)];
  const rows = here.map(({ name }) => {
    const { ours, peers: theirs } = record.materials[name];
    return rowOf([`[${name}](${kAddress}${encodeURIComponent(name)})`, ours.mean, ...peers.map((peer) => cell(theirs[peer.name]))]);
  });
  const lines = here.map(({ name, section, says }) => `- **${name}**${section ? ` (${section})` : ''}: ${says}`);
  return [`![${here.map(({ name }) => name).join(', ')}](images/${sheetName(first)})`, '',
    rowOf(head), `|${'---|'.repeat(head.length)}`, ...rows, '', ...lines].join('\n');
}

/** The page as the record and the gallery say. */
export function galleryPage(record, entries) {
  const peers = shownPeers(record);
  const names = peers.map((peer) => `${peer.title} ${record.versions[peer.package]}`);
  const sections = [];
  for (let i = 0; i < entries.length; i += kSheetRows) sections.push(sheetSection(record, entries, i));
  return `# The gallery

${entries.length} materials, one for each extension and the interesting pairs, on the same ball: ours, and beside it, each with four
times the difference, ${names.join(', ')}, a row for each line of a table. \`./dev bench gallery\` draws it and writes this page; the materials
are [bench/peers/gallery.gltf](../bench/peers/gallery.gltf), the numbers [bench/gallery.json](../bench/gallery.json), and light and
camera those of [the measurements](cost.md#the-peers), with a wall as bright as the environment behind what lets light through.

After \`./dev web\` a material's name opens it in [the editor](web.md), whose list of files has the gallery, too.

- Of a peer: how far what the extension changes in its picture is from what it changes in ours, as a part of the latter (0 %: the
  same), then the mean and the largest difference of the pictures, in linear RGB.
- "no": with and without the extension the peer has the same shader, the same numbers in it and the same picture. No figure before
  the difference: core glTF, or an effect that this light does not show.
- MaterialX gets the document that we write of a material; what that cannot say, it does not know here.
- The largest difference is often that of a highlight a few pixels wide: the coats have a roughness of 0.1.
- The light flatters everybody: the environment is the same from all sides, so that no filter and no direction of a lookup shows.

<!-- gallery: -->
${sections.join('\n\n')}
<!-- :gallery -->
`;
}

export function galleryPages(root) {
  const record = JSON.parse(readFileSync(`${root}/bench/gallery.json`, 'utf8'));
  return { [`${root}/docs/gallery.md`]: galleryPage(record, readGallery(`${root}/bench/peers`)) };
}

/** The page, from the record. */
export function writeGalleryPages(root) {
  for (const [path, text] of Object.entries(galleryPages(root))) writeFileSync(path, text);
}

export function writeGallery(root, record) {
  writeFileSync(`${root}/bench/gallery.json`, `${JSON.stringify(record, null, 1)}\n`);
  writeGalleryPages(root);
}
