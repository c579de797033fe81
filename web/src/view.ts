// What part of the images is seen: one place and zoom for all of them.

export class View {
    zoom = 1;  // CSS pixels per image pixel
    x = 0;     // the image's point in the middle of the canvas
    y = 0;
    fitted = true;

    constructor(readonly image_width: number, readonly image_height: number, public width = 1, public height = 1) {}

    // Small images are enlarged to fit, and can be seen in their own size all the same.
    least_zoom(): number { return Math.min(this.fit_zoom(), 1); }

    fit_zoom(): number { return Math.min(this.width / this.image_width, this.height / this.image_height); }

    fit(): void {
        this.zoom = this.fit_zoom();
        this.x = this.image_width / 2;
        this.y = this.image_height / 2;
        this.fitted = true;
    }

    resize(width: number, height: number): void {
        this.width = width;
        this.height = height;
        if (this.fitted) this.fit();
    }

    // The image's point under a point of the canvas.
    to_image(cx: number, cy: number): [number, number] {
        return [this.x + (cx - this.width / 2) / this.zoom, this.y + (cy - this.height / 2) / this.zoom];
    }

    // The point (cx, cy) of the canvas keeps its place.
    zoom_by(factor: number, cx = this.width / 2, cy = this.height / 2): void {
        const [ix, iy] = this.to_image(cx, cy);
        this.zoom = Math.min(Math.max(this.zoom * factor, this.least_zoom()), 64);
        this.fitted = this.zoom === this.fit_zoom();
        this.x = ix - (cx - this.width / 2) / this.zoom;
        this.y = iy - (cy - this.height / 2) / this.zoom;
        this.keep_inside();
    }

    // By pixels of the canvas.
    pan(dx: number, dy: number): void {
        this.x -= dx / this.zoom;
        this.y -= dy / this.zoom;
        this.keep_inside();
    }

    private keep_inside(): void {
        if (this.fitted) this.fit();
        this.x = Math.min(Math.max(this.x, 0), this.image_width);
        this.y = Math.min(Math.max(this.y, 0), this.image_height);
    }
}
