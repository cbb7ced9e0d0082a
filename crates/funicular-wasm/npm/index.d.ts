import type { Requests, Results } from "./schema.js";

export type { Requests, Results } from "./schema.js";

/** Command with a request. */
export type Command = keyof Requests;

/** Request of a command; the robot may be given beside it. */
export type Request<C extends Command = Command> = C extends Command
  ? Omit<Requests[C], "robot"> & ("robot" extends keyof Requests[C] ? { robot?: Requests[C]["robot"] } : unknown)
  : never;

/** Results of a command, as the program prints them with `--format json`. */
export type Answer<C extends Command> = C extends keyof Results ? Results[C] : unknown;

/** Error of a request without results. */
export class RequestError extends Error {
  constructor(message: string, status: number);
  /** 1: the robot has no such solution; 2: the request has to change. */
  status: number;
}

/** Error of a mistake in funicular, or of exhausted memory: await `renew()`. */
export class BrokenError extends Error {
  constructor(message: string, cause?: unknown);
}

/** Numbers for animations, and what describes them. */
export interface Numbers {
  numbers: Float64Array;
  about: unknown;
}

/** Instance of funicular. It runs on the thread that calls it. */
export class Funicular {
  constructor(module: WebAssembly.Module);
  /** Starts a new instance. */
  renew(): Promise<void>;
  /** True if the instance has to be started again. */
  readonly broken: boolean;
  /** Answers a request; the robot file may be given as text. */
  answer<C extends Command>(request: Request<C> & { command: C }, robotFile?: string, robotName?: string): Answer<C>;
  /** Answers a request in text, with every digit that the program prints. */
  answerText(request: string): string;
  /** Reads the robot of the frames. */
  robot(request: object): unknown;
  /** Computes a frame: equilibrium, curves of the cables, lowest natural frequencies. */
  frame(kind: number, state: ArrayLike<number>, modes: number, points: number): Numbers;
  /** Continues the list of modes up to the first mode of the platform. */
  platform(): Numbers;
  /** Displacements of points on all cables in a mode of the last frame. */
  mode(index: number, points: number): Float64Array;
  /** Response at the equilibrium of the last frame. */
  response(request: object): Numbers;
  /** Follows rays from a pose to where the conditions of `workspace` end. */
  reach(pose: ArrayLike<number>, level: number): Numbers;
  /** Reads a table in CSV into columns. */
  table(text: string, name?: string): unknown;
}

/** Loads funicular from an answer of `fetch`, from bytes, or from a compiled module. */
export function load(source: Response | BufferSource | WebAssembly.Module): Promise<Funicular>;

/** Loads the module that lies beside this package. */
export function start(): Promise<Funicular>;

/** Address of the module. */
export const wasm: URL;
