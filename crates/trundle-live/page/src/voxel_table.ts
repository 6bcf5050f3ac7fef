// The slot of each voxel: a table of hashed keys that drops its oldest voxel when it is full. It allocates nothing after its start.

/** Number of hashed keys; a power of two above the number of voxels keeps the chains short. */
const HEADS = 1 << 18;
const NONE = -1;

export class VoxelTable {
  /** Number of voxels. */
  count = 0;
  /** Slot of the next new voxel: the oldest one when the table is full. */
  private oldest = 0;
  private readonly keys: Int32Array;
  /** The first voxel of each hashed key, and the next one after each voxel. */
  private readonly first = new Int32Array(HEADS).fill(NONE);
  private readonly next: Int32Array;

  constructor(private readonly capacity: number) {
    this.keys = new Int32Array(3 * capacity);
    this.next = new Int32Array(capacity);
  }

  clear(): void {
    this.count = this.oldest = 0;
    this.first.fill(NONE);
  }

  /** The slot of a voxel; a new voxel takes the slot of the oldest one when the table is full. */
  slot(x: number, y: number, z: number): number {
    const { keys, next } = this;
    const head = hash(x, y, z);
    for (let i = this.first[head]!; i !== NONE; i = next[i]!) {
      if (keys[3 * i] === x && keys[3 * i + 1] === y && keys[3 * i + 2] === z) return i;
    }
    const slot = this.free();
    keys[3 * slot] = x;
    keys[3 * slot + 1] = y;
    keys[3 * slot + 2] = z;
    // The chain may have begun with the voxel that was dropped.
    next[slot] = this.first[head]!;
    this.first[head] = slot;
    return slot;
  }

  private free(): number {
    const slot = this.oldest;
    this.oldest = (slot + 1) % this.capacity;
    if (this.count < this.capacity) this.count += 1;
    else this.drop(slot);
    return slot;
  }

  /** Takes a voxel out of its chain. */
  private drop(slot: number): void {
    const { keys, next, first } = this;
    const head = hash(keys[3 * slot]!, keys[3 * slot + 1]!, keys[3 * slot + 2]!);
    if (first[head] === slot) {
      first[head] = next[slot]!;
      return;
    }
    let before = first[head]!;
    while (next[before] !== slot) before = next[before]!;
    next[before] = next[slot]!;
  }
}

function hash(x: number, y: number, z: number): number {
  const mixed = Math.imul(x, 73856093) ^ Math.imul(y, 19349663) ^ Math.imul(z, 83492791);
  return (mixed ^ (mixed >>> 15)) & (HEADS - 1);
}
