// From pixel values to 8-bit colours: exposed images, and errors in false colours.
import {half_values, type Pixels} from "./pixels";

const epsilon = 1e-3;  // metric_epsilon of src/compare/metrics.h

export interface ErrorMetric {
    name: string;
    formula: string;
    // Of one channel: value, reference, and the mean of the reference's values.
    error(i: number, r: number, mean: number): number;
}

const ratio = (a: number, b: number): number => (a === 0 ? 0 : a / b);
const denominator = (r: number, mean: number): number => r * r + epsilon * mean * mean;

export const error_metrics: Record<string, ErrorMetric> = {
    relative_squared: {
        name: "Relative squared error",
        formula: "(I−R)² / (R² + 0.001 mean(R)²)",
        error: (i, r, mean) => ratio((i - r) ** 2, denominator(r, mean)),
    },
    squared: {name: "Squared error", formula: "(I−R)²", error: (i, r) => (i - r) ** 2},
    absolute: {name: "Absolute error", formula: "|I−R|", error: (i, r) => Math.abs(i - r)},
    relative_absolute: {
        name: "Relative absolute error",
        formula: "|I−R| / √(R² + 0.001 mean(R)²)",
        error: (i, r, mean) => ratio(Math.abs(i - r), Math.sqrt(denominator(r, mean))),
    },
    smape: {
        name: "SMAPE",
        formula: "2 |I−R| / (|I| + |R|)",
        error: (i, r) => ratio(2 * Math.abs(i - r), Math.abs(i) + Math.abs(r)),
    },
};

// Every half has one 8-bit value, so exposing an image is a look-up. `exposure` in stops; sRGB, clipped.
export function expose(pixels: Pixels, exposure: number): ImageData {
    const gain = pixels.scale * 2 ** exposure;
    const encoded = Uint8ClampedArray.from(half_values, (value) => {
        const linear = value * gain;
        return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);
    });
    const image = new ImageData(pixels.width, pixels.height), {data} = image, {count, halves} = pixels;
    for (let pixel = 0; pixel < count; ++pixel) {
        data[4 * pixel] = encoded[halves[pixel]!]!;
        data[4 * pixel + 1] = encoded[halves[count + pixel]!]!;
        data[4 * pixel + 2] = encoded[halves[2 * count + pixel]!]!;
        data[4 * pixel + 3] = 255;
    }
    return image;
}

// Per pixel, the mean over its channels; NaN where a value is not finite.
export function pixel_errors(pixels: Pixels, reference: Pixels, metric: ErrorMetric): Float32Array {
    const {count} = pixels, mean = reference.mean(), errors = new Float32Array(count);
    for (let channel = 0; channel < 3; ++channel)
        for (let pixel = 0; pixel < count; ++pixel)
            errors[pixel]! += metric.error(pixels.value(channel, pixel), reference.value(channel, pixel), mean) / 3;
    return errors;
}

// The value below which the share `fraction` of the errors lies.
export function quantile(errors: Float32Array, fraction: number): number {
    const numbers = errors.filter((error) => !Number.isNaN(error)).sort();
    return numbers[Math.floor(fraction * (numbers.length - 1))] ?? 0;
}

// Grey where there is no number, as false_colour of src/compare/false_colour.h.
export function false_colours(errors: Float32Array, width: number, maximum: number,
                              map: [number, number, number][]): ImageData {
    const image = new ImageData(width, errors.length / width), {data} = image;
    for (let pixel = 0; pixel < errors.length; ++pixel) {
        const error = errors[pixel]!;
        const place = Math.round(Math.min(error > 0 ? error / maximum : 0, 1) * (map.length - 1));
        const colour = Number.isNaN(error) ? [128, 128, 128] : map[place]!;
        data.set(colour, 4 * pixel);
        data[4 * pixel + 3] = 255;
    }
    return image;
}
