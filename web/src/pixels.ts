// The images' data: decoded when first asked for, from the text of the page.
//
// Base64 of a zlib stream of 6 * n bytes, n = width * height: the high bytes of all halves, then the low bytes; the
// channels one after another, each half as its difference (mod 2^16) from the one before. See src/compare/report.cpp.
import type {ImageInfo, PageData} from "./results";

// The values of all 65536 halves.
export const half_values = Float32Array.from({length: 65536}, (_, bits) => {
    const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, mantissa = bits & 1023;
    if (exponent === 31) return mantissa ? NaN : sign * Infinity;
    return sign * (exponent ? (1024 + mantissa) * 2 ** (exponent - 25) : mantissa * 2 ** -24);
});

export class Pixels {
    // Three planes of halves: red, green, blue.
    constructor(readonly width: number, readonly height: number, readonly scale: number, readonly halves: Uint16Array) {}

    get count(): number { return this.width * this.height; }

    value(channel: number, pixel: number): number {
        return half_values[this.halves[channel * this.count + pixel]!]! * this.scale;
    }

    mean(): number {
        let sum = 0, finite = 0;
        for (const half of this.halves) {
            const value = half_values[half]!;
            if (Number.isFinite(value)) { sum += value; ++finite; }
        }
        return (sum / Math.max(finite, 1)) * this.scale;
    }
}

async function decode(info: ImageInfo, base64: string): Promise<Pixels> {
    const compressed = (await fetch(`data:application/octet-stream;base64,${base64}`)).body!;
    const stream = compressed.pipeThrough(new DecompressionStream("deflate"));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
    const count = 3 * info.width * info.height;
    if (bytes.length !== 2 * count) throw new Error(`the data of image "${info.name}" is not complete`);
    const halves = new Uint16Array(count);
    for (let i = 0, half = 0; i < count; ++i) {
        half = (half + (bytes[i]! << 8) + bytes[count + i]!) & 0xffff;
        halves[i] = half;
    }
    return new Pixels(info.width, info.height, info.scale, halves);
}

export class Images {
    private readonly decoding = new Map<number, Promise<Pixels>>();
    private readonly ready = new Map<number, Pixels>();

    constructor(readonly infos: ImageInfo[]) {}

    static of(data: PageData): Images { return new Images(data.images); }

    get(index: number): Pixels | undefined { return this.ready.get(index); }

    load(index: number): Promise<Pixels> {
        let promise = this.decoding.get(index);
        if (!promise) {
            promise = decode(this.infos[index]!, document.getElementById(`image-${index}`)!.textContent!.trim());
            promise.then((pixels) => this.ready.set(index, pixels), () => undefined);
            this.decoding.set(index, promise);
        }
        return promise;
    }
}
