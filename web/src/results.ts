// The types of results.json (docs/results.schema.json) and of the data in the page. Whatever is unknown is absent.

// Mean over runs with a 95% confidence interval.
export interface Estimate {
    mean?: number | null;
    low?: number | null;
    high?: number | null;
}

export interface Strategy {
    name: string;
    proposals?: number;
    accepted?: number;
    mean_acceptance?: number | null;
    failures?: Record<string, number>;
    effective_sample_size?: number | null;
    autocorrelation_time?: number | null;
}

export interface ConvergencePoint {
    seconds?: number;
    cpu_seconds?: number;
    mutations?: number;
    relmse?: Estimate;
    variance?: Estimate;
    squared_bias?: Estimate;
}

export interface Entry {
    name: string;
    kind?: "mix" | "integrator";
    description?: string;
    mix?: string;
    parameter?: {name: string; value: number};
    knob?: {name: string; value: string};
    runs?: number;
    metrics?: Record<string, Estimate>;
    split?: {variance?: Estimate; squared_bias?: Estimate};
    convergence?: ConvergencePoint[];
    strategies?: Strategy[];
    mutations_per_second?: Estimate;
    time_split?: Record<string, number>;
    speed_up?: Estimate;
    warnings?: string[];
}

// An entry as a setting of a knob of keyhole tradeoff.
export interface Setting {
    entry: string;
    value: string;
    microseconds_per_mutation: number;
    relmse?: Estimate;
    variance?: Estimate;
    squared_bias?: Estimate;
    efficiency?: Estimate;
    speed_up?: Estimate;
}

export interface Knob {
    knob: string;
    conclusion: string;
    settings: Setting[];
}

export interface Reference {
    integrator?: string;
    samples_per_pixel?: number;
    seconds?: number;
    relmse?: number | null;
    file?: string;
}

export interface Results {
    scene?: {file?: string; name?: string; width?: number; height?: number; max_length?: number};
    command?: string;
    equal?: "time" | "mutations" | "cpu";
    budget?: number;
    runs?: number;
    threads?: number;
    seed?: number;
    keyhole?: string;
    machine?: string;
    created?: string;
    reference?: Reference;
    entries?: Entry[];
    tradeoff?: Knob[];
    warnings?: string[];
}

// Image i of the page; its pixels are the text of the element with the id `image-i`.
export interface ImageInfo {
    name: string;
    width: number;
    height: number;
    scale: number;  // what a stored half is multiplied by
}

export interface PageData {
    results: Results;
    images: ImageInfo[];
    colour_map: [number, number, number][];  // of errors, from 0 to the maximum, 8-bit sRGB
}

export function read_page_data(): PageData {
    return JSON.parse(document.getElementById("data")!.textContent!) as PageData;
}

export function is_number(value: number | null | undefined): value is number {
    return typeof value === "number" && Number.isFinite(value);
}
