// The image viewer: its state and what it draws. Controls are in viewer_controls.ts.
import {Images, type Pixels} from "./pixels";
import {error_metrics, expose, false_colours, pixel_errors, quantile} from "./tone";
import {View} from "./view";

export interface ViewerState {
    shown: number;   // index of an image
    split: boolean;  // `other` is seen on the right of the divider
    other: number;
    divider: number;  // share of the width
    mode: string;     // "image" or a key of error_metrics
    exposure: number;
    maximum: number;  // of the false colours
    pixel: [number, number] | null;  // under the cursor
}

export class Viewer {
    readonly view: View;
    readonly state: ViewerState;
    private readonly layers = new Map<number, {key: string; canvas: HTMLCanvasElement}>();
    private errors: {key: string; values: Float32Array}[] = [];  // the last few
    private scheduled = false;

    constructor(readonly canvas: HTMLCanvasElement, readonly images: Images, readonly reference: number,
                readonly map: [number, number, number][], private readonly changed: () => void,
                private readonly failed: (message: string) => void) {
        const {width, height} = images.infos[0]!;
        this.view = new View(width, height);
        const shown = images.infos.length > 1 && reference === 0 ? 1 : 0;
        this.state = {shown, split: false, other: Math.max(reference, 0), divider: 0.5, mode: "image", exposure: 0,
                      maximum: NaN, pixel: null};
        new ResizeObserver(() => this.resize()).observe(canvas);
    }

    update(change: Partial<ViewerState>): void {
        if (change.mode !== undefined && change.mode !== this.state.mode) change.maximum ??= NaN;
        Object.assign(this.state, change);
        this.redraw();
    }

    // Draws before the next frame, once, and again when an image that it needs has been decoded.
    redraw(): void {
        if (this.scheduled) return;
        this.scheduled = true;
        requestAnimationFrame(() => {
            this.scheduled = false;
            this.draw();
            this.changed();
        });
    }

    // The images of the layers that are seen now.
    seen(): number[] {
        return this.state.split ? [this.state.shown, this.state.other] : [this.state.shown];
    }

    private resize(): void {
        const {clientWidth, clientHeight} = this.canvas, ratio = devicePixelRatio;
        this.canvas.width = Math.round(clientWidth * ratio);
        this.canvas.height = Math.round(clientHeight * ratio);
        this.view.resize(clientWidth, clientHeight);
        this.redraw();
    }

    // Decoded now or, with another redraw, later.
    pixels(index: number): Pixels | undefined {
        const pixels = this.images.get(index);
        if (!pixels)
            this.images.load(index).then(() => this.redraw(), (error: Error) => this.failed(error.message));
        return pixels;
    }

    // Per pixel, by the metric that is shown; undefined for the image itself and while the data are being decoded.
    pixel_errors(index: number): Float32Array | undefined {
        const metric = error_metrics[this.state.mode], pixels = this.pixels(index), key = `${this.state.mode} ${index}`;
        const reference = metric && this.pixels(this.reference);
        if (!pixels || !reference) return undefined;
        let errors = this.errors.find((known) => known.key === key)?.values;
        if (!errors) {
            errors = pixel_errors(pixels, reference, metric);
            this.errors = [{key, values: errors}, ...this.errors].slice(0, 4);
        }
        return errors;
    }

    // The scale of the false colours is set by the first errors shown, and kept for all entries.
    private error_image(index: number): ImageData | undefined {
        const {state} = this, errors = this.pixel_errors(index);
        if (!errors) return undefined;
        if (Number.isNaN(state.maximum) && index !== this.reference) state.maximum = quantile(errors, 0.99) || 1;
        return false_colours(errors, this.view.image_width, state.maximum || 1, this.map);
    }

    private layer(index: number): HTMLCanvasElement | undefined {
        const {mode, exposure, maximum} = this.state, known = this.layers.get(index);
        const key = mode === "image" ? `exposure ${exposure}` : `${mode} ${maximum}`;
        if (known?.key === key) return known.canvas;
        const pixels = this.pixels(index);
        const image = pixels && (mode === "image" ? expose(pixels, exposure) : this.error_image(index));
        if (!image) return undefined;
        const canvas = known?.canvas ?? document.createElement("canvas");
        canvas.width = image.width;
        canvas.height = image.height;
        canvas.getContext("2d")!.putImageData(image, 0, 0);
        this.layers.set(index, {key: mode === "image" ? key : `${mode} ${this.state.maximum}`, canvas});
        return canvas;
    }

    // Keeps what is on the canvas while an image is being decoded.
    private draw(): void {
        const context = this.canvas.getContext("2d")!, {width, height} = this.canvas, {view, state} = this;
        const layers = this.seen().map((index) => this.layer(index));
        if (layers.includes(undefined)) return;
        const ratio = devicePixelRatio, zoom = view.zoom * ratio, edge = Math.round(state.divider * width);
        context.clearRect(0, 0, width, height);
        const draw = (layer: HTMLCanvasElement, left: number, right: number): void => {
            context.save();
            context.beginPath();
            context.rect(left, 0, right - left, height);
            context.clip();
            context.imageSmoothingEnabled = zoom < 1;
            context.imageSmoothingQuality = "high";
            context.setTransform(zoom, 0, 0, zoom, width / 2 - view.x * zoom, height / 2 - view.y * zoom);
            context.drawImage(layer, 0, 0);
            context.restore();
        };
        if (!state.split) return draw(layers[0]!, 0, width);
        draw(layers[0]!, 0, edge);
        draw(layers[1]!, edge, width);
        context.fillStyle = "#000";
        context.fillRect(edge - 1.5 * ratio, 0, 3 * ratio, height);
        context.fillStyle = "#fff";
        context.fillRect(edge - 0.5 * ratio, 0, ratio, height);
    }
}
