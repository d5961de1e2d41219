// What the document's material stands in: two lamps that are placed by hand, and how far the surroundings are turned.
import { directional, type Light } from './lights';
import type { Vec3 } from '../src/math';

/** A lamp far away, in the direction of its handle. */
export interface Lamp {
  on: boolean;
  /** As the page's inputs have it: sRGB, #rrggbb. */
  color: string;
  strength: number;
  /** Angles about the middle of what is seen: around from +z to +x, and up. */
  yaw: number;
  pitch: number;
}

export interface Stage {
  /** The lamps are lit: else others are chosen. */
  placed: boolean;
  lamps: [Lamp, Lamp];
  /** The angle of the surroundings about +y. */
  turn: number;
}

export const kMostStrength = 10;
export const kSteepest = 1.55;

/** As the lamps of the studio, which they stand in for. */
export const kStage: Stage = {
  placed: false,
  lamps: [
    { on: true, color: '#fffcf7', strength: 1, yaw: -0.785, pitch: 0.615 },
    { on: true, color: '#e5f0ff', strength: 0.25, yaw: 1.265, pitch: 0.217 },
  ],
  turn: 0,
};

/** What a file says, as far as it can be: files come from anybody. */
export function stageOf(said: any): Stage {
  const within = (x: unknown, least: number, most: number, otherwise: number) =>
    typeof x === 'number' && Number.isFinite(x) ? Math.min(Math.max(x, least), most) : otherwise;
  const lampOf = (lamp: any, otherwise: Lamp): Lamp => ({
    on: typeof lamp?.on === 'boolean' ? lamp.on : otherwise.on,
    color: /^#[0-9a-f]{6}$/.test(lamp?.color) ? lamp.color : otherwise.color,
    strength: within(lamp?.strength, 0, kMostStrength, otherwise.strength),
    yaw: within(lamp?.yaw, -Math.PI, Math.PI, otherwise.yaw),
    pitch: within(lamp?.pitch, -kSteepest, kSteepest, otherwise.pitch),
  });
  return {
    placed: said?.placed === true,
    lamps: [lampOf(said?.lamps?.[0], kStage.lamps[0]), lampOf(said?.lamps?.[1], kStage.lamps[1])],
    turn: within(said?.turn, -Math.PI, Math.PI, 0),
  };
}

/** The same angle from -pi to pi. */
export const around = (angle: number) => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));

export const towards = ({ yaw, pitch }: Lamp): Vec3 => [Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch)];
export const anglesTo = ([x, y, z]: Vec3) => ({
  yaw: Math.atan2(x, z), pitch: Math.min(Math.max(Math.asin(Math.min(Math.max(y, -1), 1)), -kSteepest), kSteepest),
});

const linear = (x: number) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
/** Of those that are on, as the shaders are given them. */
export function lightsOf({ lamps }: Stage): Light[] {
  return lamps.filter(({ on }) => on).map((lamp) => {
    const radiance = [1, 3, 5].map((at) => lamp.strength * linear(parseInt(lamp.color.slice(at, at + 2), 16) / 255)) as Vec3;
    return directional(towards(lamp), radiance);
  });
}
