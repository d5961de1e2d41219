// The file's nodes at a moment of a clip: where its meshes are, and how skins and morph targets bend them. It is the processor that
// bends them, so that every shader of a material draws them.
import { Reader } from '../src/accessors';
import type { Drawable, GltfFile, Mat4, Numbers } from '../src/gltf';
import { isCount, isNear, item, list, numbersOf, once, rootsOf } from '../src/json';
import { compose, identity, mirrors, multiply, normalMatrix } from '../src/math';
import { Bent, sizesOf, type Skin, type Target } from './bend';
import { ClipReader, valueAt, type Clip, type Part } from './clips';
import { Visibility } from './visibility';

/** Of a file, so that a picture takes no seconds: influences of joints and changes by morph targets, each of one vertex. What has
 * more of them is drawn as it rests. */
const kMostInfluences = 2 ** 22;
const kMostChanges = 2 ** 24;
/** Sets of four joints that a vertex may have. */
const kMostSets = 4;
const kCounts = ['no', 'one', 'two', 'three'];
/** What is said of a file at most. */
const kMostSaid = 8;

interface Place {
  parent: number;
  /** None where the node has a matrix. */
  rest: { translation: number[]; rotation: number[]; scale: number[] } | null;
  now: { translation: number[]; rotation: number[]; scale: number[] } | null;
  matrix: Mat4;
  world: Mat4;
  moved: boolean;
}

/** Primitives of a mesh at one node, which are bent as one. */
interface Bending {
  node: number;
  bent: Bent;
}

export class Moves {
  readonly clips: Clip[];
  /** What is wrong in the file. */
  readonly said: string[] = [];
  /** Numbers of lamps and cameras that the clip has now, by their pointers. */
  readonly moved = new Map<string, number[]>();
  private readonly places: Place[] = [];
  /** The nodes, each behind its parent. */
  private readonly order: number[] = [];
  private readonly skins = new Map<number, Skin | null>();
  private readonly bendings: Bending[] = [];
  /** By their nodes, those that go where the nodes go. */
  private readonly carried = new Map<number, Drawable[]>();
  /** What the clip had moved in the pose before. */
  private touched = new Set<number>();
  private readonly targetCounts = new Map<unknown, number>();
  /** By primitives: what their targets change. */
  private readonly targetNames = new Map<unknown, Set<string>>();
  /** Whether one of a list's weights is not 0. */
  private readonly weighs = new Map<unknown, boolean>();
  private readonly joints = new Map<Skin, Map<Drawable['attributes'], [Numbers, Numbers][]>>();
  private readonly from: Reader;
  private readonly visibility: Visibility;
  /** A clip has said of nodes whether they are seen. */
  private flashed = false;
  private influences = kMostInfluences;
  private changes = kMostChanges;

  constructor(private readonly file: GltfFile, drawables: Drawable[]) {
    this.from = new Reader(file);
    this.readNodes();
    this.clips = new ClipReader(this.from, (node) => this.targetCount(node), (text) => this.say(text)).clips();
    const weighted = new Set(this.clips.flatMap(({ channels }) => channels.flatMap(({ node, part }) => (part === 'weights' ? [node] : []))));
    const known = new Map<string, Map<Drawable['attributes'], Bent | null>>();
    for (const drawable of drawables) {
      const { node } = drawable;
      if (node === undefined) continue;
      // Instances of a node are bent once.
      const bent = once(once(known, String(node), () => new Map()), drawable.attributes, () => this.bentOf(node, drawable, weighted.has(node)));
      if (bent) drawable.attributes = bent.attributes;
      if (bent?.skin) {
        drawable.model = drawable.instance ?? identity(); // its joints place it
        drawable.normal = normalMatrix(drawable.model);
        drawable.mirrored = mirrors(drawable.model) !== mirrors(bent.skin.matrices.subarray(0, 16));
      } else once(this.carried, node, () => []).push(drawable);
    }
    for (const { bent } of this.bendings) bent.bend(null, true);
    this.visibility = new Visibility(list(this.json.nodes), this.order, (node) => this.places[node].parent, drawables);
  }

  private get json(): any {
    return this.file.json;
  }
  private say(text: string): void {
    if (this.said.length === kMostSaid) this.said.push('and more');
    if (this.said.length < kMostSaid) this.said.push(`${this.file.name}: ${text}`);
  }

  // ---- what is read

  /** As eachNode() goes, and then the nodes that are in no scene: joints may be there. */
  private readNodes(): void {
    const nodes = list(this.json.nodes);
    const { scenes, scene = 0 } = this.json;
    const seen = new Set<number>();
    const walk = (roots: any[]) => {
      const open: [number, number][] = [...roots].reverse().map((root) => [root, -1]);
      for (let next = open.pop(); next; next = open.pop()) {
        const [index, parent] = next;
        const node = item(nodes, index);
        if (!node) continue;
        if (seen.has(index)) {
          if (parent >= 0) this.say(`/nodes/${parent}/children: node ${index} has another parent, or is above itself; it is where it was met first`);
          continue;
        }
        seen.add(index);
        this.order.push(index);
        this.places[index] = placeOf(node, parent);
        for (const child of [...list(node.children)].reverse()) open.push([child, index]);
      }
    };
    const roots = item(scenes, scene)?.nodes;
    if (roots !== undefined) walk(list(roots));
    walk(rootsOf(nodes).filter((i) => !seen.has(i)));
    this.carry();
  }

  private targetCount(node: number): number {
    const { mesh } = item(this.json.nodes, node);
    const count = () => list(item(this.json.meshes, mesh)?.primitives).reduce((most, each) => Math.max(most, list(each?.targets).length), 0);
    return once(this.targetCounts, mesh, count);
  }

  /** How a primitive is bent; null where it is not, or cannot be. */
  private bentOf(index: number, drawable: Drawable, weighted: boolean): Bent | null {
    const node = item(this.json.nodes, index);
    const of = item(item(this.json.meshes, node.mesh)?.primitives, drawable.primitive);
    const at = `/meshes/${node.mesh}/primitives/${drawable.primitive}`;
    const vertices = drawable.attributes.get('POSITION')!.data.length / 3;
    const skin = node.skin === undefined ? null : once(this.skins, node.skin, () => this.skinOf(node.skin));
    const sets = skin ? once(once(this.joints, skin, () => new Map()), drawable.attributes, () => this.jointsOf(drawable, skin, at)) : [];
    const resting = node.weights ?? item(this.json.meshes, node.mesh)?.weights;
    const morphs = weighted || once(this.weighs, resting, () => list(resting).some((weight) => weight !== 0));
    const count = morphs ? this.targetCount(index) : 0;
    if (sets.length === 0 && count === 0) return null;
    const influences = 4 * vertices * sets.length;
    const given = () => new Set<string>(list(of.targets).flatMap((target) => Object.keys(target ?? {})));
    const names = Bent.names(drawable.attributes, count > 0 ? once(this.targetNames, of, given) : new Set());
    const changes = vertices * count * Math.ceil(names.length / 3);
    const numbers = names.reduce((sum, name) => sum + drawable.attributes.get(name)!.data.length, 0);
    if (influences > this.influences || changes > this.changes || !this.from.takes(numbers)) {
      this.say(`${at}: there is too much of the file to be bent: it is drawn at rest`);
      return null;
    }
    this.influences -= influences;
    this.changes -= changes;
    const weights = Array.from({ length: count }, (_, i) => (isNear(list(resting)[i]) ? resting[i] : 0));
    const targets = count > 0 ? this.targetsOf(of, at, names, vertices) : [];
    const bent = new Bent(drawable, of.attributes.NORMAL === undefined, sets.length > 0 ? skin : null, sets, targets, weights);
    this.bendings.push({ node: index, bent });
    return bent;
  }

  private targetsOf(of: any, at: string, names: string[], vertices: number): Target[] {
    return list(of.targets).map((target, t) => {
      const found = new Map<string, Numbers>();
      for (const name of names) {
        if (target?.[name] === undefined) continue;
        const [least, most] = sizesOf(name);
        const read = this.from.numbers(target[name]);
        if (read && read.size >= least && read.size <= most && read.data.length === read.size * vertices && read.data.every(isNear)) found.set(name, read);
        else this.say(`${at}/targets/${t}/${name}: accessor ${JSON.stringify(target[name])} cannot be read as ${kCounts[least]} numbers for each of ${vertices} vertices; it is left out`);
      }
      return found;
    });
  }

  private skinOf(index: unknown): Skin | null {
    const skin = item(this.json.skins, index);
    const wrong = (text: string) => {
      this.say(`/skins/${JSON.stringify(index)}: ${text}; what has it is drawn at rest`);
      return null;
    };
    if (!skin) return wrong('there is no such skin');
    const joints = list(skin.joints);
    if (joints.length === 0) return wrong('it has no joints');
    const stray = joints.find((joint) => !isCount(joint) || !this.places[joint]);
    if (stray !== undefined) return wrong(`its joint ${JSON.stringify(stray)} is no node that has a place`);
    const made: Skin = { joints, inverse: null, matrices: new Float32Array(16 * joints.length), moved: true };
    if (skin.inverseBindMatrices !== undefined) {
      const read = this.from.numbers(skin.inverseBindMatrices);
      if (read?.size !== 16 || !read.data.every(isNear)) return wrong(`inverseBindMatrices, accessor ${JSON.stringify(skin.inverseBindMatrices)}, cannot be read as matrices`);
      if (read.data.length < made.matrices.length) return wrong(`it has ${joints.length} joints and ${read.data.length / 16} inverseBindMatrices`);
      made.inverse = read.data;
    }
    this.setJoints(made);
    return made;
  }

  /** JOINTS_n and WEIGHTS_n; none, and a message, where they do not fit the skin. */
  private jointsOf({ attributes }: Drawable, skin: Skin, at: string): [Numbers, Numbers][] {
    const sets: [Numbers, Numbers][] = [];
    for (let n = 0; n < kMostSets; ++n) {
      const [joints, weights] = [attributes.get(`JOINTS_${n}`), attributes.get(`WEIGHTS_${n}`)];
      if (joints?.size !== 4 || weights?.size !== 4) break;
      const wrong = joints.data.findIndex((joint, i) => weights.data[i] !== 0 && !(Number.isInteger(joint) && joint < skin.joints.length && isNear(weights.data[i])));
      if (wrong >= 0) {
        this.say(`${at}/attributes/JOINTS_${n}: vertex ${Math.floor(wrong / 4)} has joint ${joints.data[wrong]} by ${weights.data[wrong]}, of a skin with ${skin.joints.length}; it is drawn at rest`);
        return [];
      }
      sets.push([joints, weights]);
    }
    if (sets.length === 0) this.say(`${at}: its node has a skin, and it has no JOINTS_0 and WEIGHTS_0 that can be read: it is drawn at rest`);
    return sets;
  }

  // ---- moments

  /** Takes all to where it is at a moment of a clip; to rest with none. What a clip does not move is at rest. */
  pose(clip: Clip | null, seconds: number): void {
    const dirty = new Set(this.touched);
    for (const index of this.touched) if (this.places[index]) this.rest(this.places[index]);
    const weights = new Map<number, number[]>();
    const seen = new Map<number, boolean>();
    this.touched = new Set();
    for (const channel of clip?.channels ?? []) {
      const { node, part } = channel;
      const value = valueAt(channel, seconds, part === 'rotation');
      if (part === 'weights') {
        weights.set(node, value);
        continue;
      }
      if (part === 'visible') {
        seen.set(node, value[0] !== 0);
        continue;
      }
      const now = this.places[node]?.now;
      if (!now) continue;
      now[part as Exclude<Part, 'weights' | 'visible'>] = value;
      this.touched.add(node);
      dirty.add(node);
    }
    if (seen.size > 0 || this.flashed) this.visibility.set(seen);
    this.flashed = seen.size > 0;
    this.moved.clear();
    for (const channel of clip?.properties ?? []) this.moved.set(channel.property, valueAt(channel, seconds, false));
    for (const index of dirty) {
      const { now, matrix } = this.places[index];
      if (now) matrix.set(compose(now.translation, now.rotation, now.scale));
    }
    this.carry(dirty);
    for (const { node, bent } of this.bendings) bent.bend(weights.get(node) ?? null);
  }
  /** Where a node is in the world. */
  world(node: number): Mat4 | undefined {
    return this.places[node]?.world;
  }
  /** Whether it, or a node above it, is not to be seen now. */
  hides(node: number): boolean {
    return this.visibility.hides(node);
  }
  private rest({ now, rest }: Place): void {
    if (now && rest) Object.assign(now, rest);
  }

  /** Nodes that have moved carry what hangs on them. */
  private carry(dirty?: Set<number>): void {
    for (const index of this.order) {
      const place = this.places[index];
      const parent = this.places[place.parent];
      place.moved = dirty === undefined || dirty.has(index) || parent?.moved === true;
      if (!place.moved) continue;
      place.world = parent ? multiply(parent.world, place.matrix) : multiply(identity(), place.matrix);
      if (dirty !== undefined && place.world.every(isNear)) for (const drawable of this.carried.get(index) ?? []) take(drawable, place.world);
    }
    for (const skin of this.skins.values()) {
      if (!skin) continue;
      skin.moved = skin.joints.some((joint) => this.places[joint].moved);
      if (skin.moved) this.setJoints(skin);
    }
  }

  private setJoints({ joints, inverse, matrices }: Skin): void {
    joints.forEach((joint, j) => {
      const { world } = this.places[joint];
      matrices.set(inverse ? multiply(world, inverse.subarray(16 * j, 16 * j + 16)) : world, 16 * j);
    });
  }
}

function placeOf(node: any, parent: number): Place {
  const matrix = numbersOf(node.matrix, 16);
  const rest = {
    translation: numbersOf(node.translation, 3) ?? [0, 0, 0], rotation: numbersOf(node.rotation, 4) ?? [0, 0, 0, 1], scale: numbersOf(node.scale, 3) ?? [1, 1, 1],
  };
  return {
    parent, world: identity(), moved: true, rest: matrix ? null : rest, now: matrix ? null : { ...rest },
    matrix: matrix ? new Float32Array(matrix) : compose(rest.translation, rest.rotation, rest.scale),
  };
}

/** Puts what a node has to where the node is. */
function take(drawable: Drawable, world: Mat4): void {
  const model = drawable.instance ? multiply(world, drawable.instance) : world;
  if (!model.every(isNear)) return;
  drawable.model = model;
  drawable.normal = normalMatrix(model);
  drawable.mirrored = mirrors(model);
}
