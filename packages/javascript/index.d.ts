/** The semi-axes, in one unit, each finite and greater than 0: of x²/α² + y²/α² − z²/γ² = 1, and b, b, d of the spheroid. */
export interface Sizes {
  alpha: number;
  gamma: number;
  b: number;
  /** Along the spheroid's axis of revolution. */
  d: number;
}

/** x, y, z from the hyperboloid's centre. */
export type Point = readonly [number, number, number] | ArrayLike<number>;

/** +1 exterior, 0 contact (a tangency included), −1 interior. */
export type Position = 1 | 0 | -1;

export interface Tilt {
  /** Along the spheroid's axis of revolution, of any length and sign; upright without. */
  axis?: Point;
}

/** Where the hyperboloid ends. */
export interface Ends extends Tilt {
  zMin?: number;
  zMax?: number;
  /** Whether flat ends belong to it; else the wall alone is there. */
  solid?: boolean;
}

export declare const EXTERIOR: 1;
export declare const CONTACT: 0;
export declare const INTERIOR: -1;
/** The answer of classify about a row with ends where bounds do not tell, and of classifyPassages. */
export declare const UNDECIDED: 2;
/** The answer about a row that is not valid. */
export declare const INVALID: 127;

/** The version of hypcheck, which the package shares. */
export declare const version: string;

/**
 * The exact position of one spheroid. With ends it is null where bounds do not tell: within about 2⁻⁴⁶ of contact, or
 * beyond 2^±100. Throws a RangeError that names a number that is not valid.
 */
export declare function position(sizes: Sizes, center: Point, options?: Tilt): Position;
export declare function position(sizes: Sizes, center: Point, options: Ends): Position | null;

/**
 * Whether the spheroid has contact while its centre goes straight from start to end; null where bounds do not tell. Before
 * the time `notBefore`, from 0 to 1, the way is clear; it is NaN where there is no contact, or where bounds do not tell.
 */
export declare function passage(sizes: Sizes, start: Point, end: Point, options?: Ends): { hit: boolean | null; notBefore: number };

/**
 * Many positions: 1, 0, −1, UNDECIDED or INVALID. Rows lie one after the other: alpha, gamma, b, d, x, y, z (width 7), with
 * axis_x, axis_y, axis_z (10), and with z_min, z_max, solid behind these (13).
 */
export declare function classify(rows: Float64Array | Iterable<number>, options?: { width?: 7 | 10 | 13 }): Int8Array;

/** Many ways: the centre at the start and at the end (width 10), the axis (13), z_min, z_max, solid (16). */
export declare function classifyPassages(
  rows: Float64Array | Iterable<number>,
  options?: { width?: 10 | 13 | 16 },
): { hits: Int8Array; times: Float64Array };

export interface Clearance {
  position: Position;
  /** lower ≤ c ≤ upper: 1 + c times as large, the spheroid first touches. */
  lower: number;
  upper: number;
  /** The Euclidean distance lies between these two; both are 0 in contact. */
  distanceLower: number;
  distanceUpper: number;
  /** A point of the hyperboloid that is distanceUpper away at most, but for the rounding of its coordinates. */
  nearest: number[];
}

/** The clearance and the distance of one upright spheroid. */
export declare function clearance(sizes: Sizes, center: Point): Clearance;
