// What the page does while a slider moves: counted, for a machine may have much other work.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { begin, end, open } from './page.mjs';

before(begin);
after(end);

const kSlider = 'p:/materials/0/extensions/KHR_materials_coat/coatRoughnessFactor';

/** Moves a slider so many times, a frame for each, and rests until the panels have followed. */
const moved = (page, steps) => page.evaluate(async ([id, steps]) => {
  const it = window.lacquerPage;
  const slider = document.getElementById(id);
  const frame = () => new Promise((done) => requestAnimationFrame(done));
  const rest = () => new Promise((done) => setTimeout(done, 300));
  const { lacquer } = it;
  const told = { read: 0, changed: 0, changedResting: 0, programs: 0, most: 0, handler: [] };
  for (const name of ['scene', 'graph']) {
    lacquer[name] = function (...words) {
      ++told.read;
      return Object.getPrototypeOf(this)[name].apply(this, words);
    };
  }
  const before = it.viewport.programCount;
  const count = () => changes.takeRecords().length;
  const changes = new MutationObserver(() => undefined);
  const observed = { subtree: true, childList: true, attributes: true, characterData: true };
  await rest();
  told.read = 0;
  for (let i = 0; i < steps; ++i) {
    slider.value = String(0.3 + (0.4 * i) / steps);
    changes.observe(document.body, observed);
    const begin = performance.now();
    slider.dispatchEvent(new Event('input', { bubbles: true }));
    told.handler.push(performance.now() - begin);
    const changed = count();
    changes.disconnect();
    told.changed += changed;
    if (i > 0) told.most = Math.max(told.most, changed); // the first says that the file is edited now
    await frame();
  }
  changes.disconnect();
  told.reads = told.read;
  changes.observe(document.body, observed);
  let records = 0;
  const later = new MutationObserver((list) => (records += list.length));
  later.observe(document.body, observed);
  await rest();
  later.disconnect();
  told.changedResting = records;
  told.readResting = told.read - told.reads;
  told.programs = it.viewport.programCount - before;
  for (const name of ['scene', 'graph']) delete lacquer[name];
  told.handler.sort((a, b) => a - b);
  return told;
}, [kSlider, steps]);

for (const tab of ['code', 'graph', 'cost', 'notes']) {
  test(`a slider that keeps the structure compiles once for each move, and leaves the panel "${tab}" as it is`, () =>
    open(['examples/car_paint.gltf'], async (page) => {
      await page.click(`[data-tab=${tab}]`);
      await page.waitForTimeout(300);
      const steps = 60;
      const told = await moved(page, steps);
      const at = (part) => told.handler[Math.floor(part * (steps - 1))].toFixed(1);
      console.log(`# a move of a slider, with ${tab}: ${at(0.5)} ms in the middle, ${at(0.95)} ms for 95 of 100, ${at(1)} ms at most`);
      assert.equal(told.reads, steps, 'the library is asked once for each move');
      assert.ok(told.most <= 4, `a move changes ${told.most} places of the document: its number and the time`);
      assert.equal(told.programs, 0);
      assert.deepEqual([told.readResting, told.changedResting], [0, 0], 'what was not changed is not made again');
    }, { size: { width: 960, height: 360 } }));
}
