// All examples on the page: the colours of every slider, and the texts of every target.
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { root, withExamples } from './native.mjs';
import { begin, end, evaluated, evaluatedByProgram, kSmall, open, setAll, settled } from './page.mjs';

const kSamples = readdirSync(join(root, 'examples')).filter((name) => name.endsWith('.gltf')).map((name) => name.slice(0, -5)).sort();
/** How far the browser's colours may be from `lacquer eval --engine float`: a 255th, of what a display can show. */
const kTolerance = 1 / 255;

before(begin);
after(end);

for (const sample of kSamples) {
  test(`${sample}: every slider at both ends and the middle gives the colours of \`lacquer eval\``, () =>
    open([`examples/${sample}.gltf`], async (page) => {
      const materials = await page.evaluate(() => window.lacquerPage.document.names.length);
      let compared = 0;
      for (let material = 0; material < materials; ++material) {
        await page.selectOption('#material', String(material));
        await settled(page);
        const sliders = await page.evaluate(() =>
          [...document.querySelectorAll('#properties input[type=range]')].map(({ id, min, max, value }) => ({ id, min: Number(min), max: Number(max), value })),
        );
        const values = sliders.flatMap(({ id, min, max, value }) => [min, (min + max) / 2, max, value].map((x) => [id, x]));
        const all = await setAll(page, values);
        for (const [i, [id, x]] of values.entries()) {
          if (i % 4 === 3) continue; // the slider is where it was
          const got = all[i];
          assert.equal(got.status, '', `${id} ${x}`);
          const expected = compared % 40 === 0 ? evaluatedByProgram(got.json, got.name) : evaluated(got.json, material);
          got.lamp.forEach((c, k) => {
            const scale = Math.max(1, Math.abs(expected[k]));
            assert.ok(Math.abs(c - expected[k]) <= kTolerance * scale, `${got.name} ${id} = ${x}: ${got.lamp} is not ${expected}`);
          });
          ++compared;
        }
      }
      assert.ok(compared > 10, `${compared}`);
    }, { size: kSmall }));
}

const kExtension = { essl: 'glsl', glsl: 'glsl', 'glsl-gl': 'glsl', hlsl: 'hlsl', wgsl: 'wgsl' };

test('the texts on the page are those of `lacquer gen`', () => withExamples(Object.keys(kExtension), (folder, manifest) =>
  open(kSamples.map((name) => `examples/${name}.gltf`), async (page) => {
    let compared = 0;
    for (const [i, sample] of kSamples.entries()) {
      await page.selectOption('#sample', String(i));
      const file = manifest.files.find(({ source }) => source.endsWith(`/${sample}.gltf`));
      for (const material of file.materials) {
        await page.selectOption('#material', String(material.index));
        const id = await page.textContent('#id');
        assert.equal(id, material.uses[0].shader);
        for (const [target, extension] of Object.entries(kExtension)) {
          await page.selectOption('#target', target);
          const text = await page.evaluate(() => document.getElementById('code').textContent);
          assert.equal(text, readFileSync(join(folder, target, `${id}.frag.${extension}`), 'utf8'));
          ++compared;
        }
      }
    }
    assert.ok(compared > 60);
  }, { size: kSmall })));
