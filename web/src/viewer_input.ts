// Mouse, touch and keys of the viewer.
import type {Viewer} from "./viewer";

const divider_reach = 14;  // CSS pixels

function place(viewer: Viewer, event: MouseEvent): [number, number] {
    const box = viewer.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
}

function point_at(viewer: Viewer, event: MouseEvent): void {
    const [x, y] = viewer.view.to_image(...place(viewer, event)).map(Math.floor) as [number, number];
    const inside = x >= 0 && y >= 0 && x < viewer.view.image_width && y < viewer.view.image_height;
    viewer.update({pixel: inside ? [x, y] : null});
}

export function listen_to_pointers(viewer: Viewer): void {
    const {canvas, view} = viewer, pointers = new Map<number, [number, number]>();
    let divider_held = false;
    const spread = (): number => {
        const [a, b] = [...pointers.values()];
        return Math.hypot(a![0] - b![0], a![1] - b![1]);
    };
    canvas.addEventListener("pointerdown", (event) => {
        const at = place(viewer, event);
        pointers.set(event.pointerId, at);
        canvas.setPointerCapture(event.pointerId);
        divider_held = viewer.state.split && Math.abs(at[0] - viewer.state.divider * view.width) < divider_reach;
        point_at(viewer, event);
    });
    canvas.addEventListener("pointermove", (event) => {
        const before = pointers.get(event.pointerId), at = place(viewer, event);
        if (before && pointers.size === 2) {
            const old_spread = spread();
            pointers.set(event.pointerId, at);
            view.zoom_by(spread() / Math.max(old_spread, 1), at[0], at[1]);
        } else if (before) {
            pointers.set(event.pointerId, at);
            if (divider_held) viewer.state.divider = Math.min(Math.max(at[0] / view.width, 0), 1);
            else view.pan(at[0] - before[0], at[1] - before[1]);
        }
        point_at(viewer, event);
    });
    for (const end of ["pointerup", "pointercancel"] as const)
        canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
    canvas.addEventListener("pointerleave", (event) => {
        if (event.pointerType === "mouse") viewer.update({pixel: null});
    });
    canvas.addEventListener("wheel", (event) => {
        if (event.deltaY > 0 && view.zoom <= view.least_zoom()) return;  // nothing to zoom out of: the page scrolls
        event.preventDefault();
        view.zoom_by(2 ** (-event.deltaY / 300), ...place(viewer, event));
        point_at(viewer, event);
    }, {passive: false});
    canvas.addEventListener("dblclick", (event) => {
        if (view.fitted) view.zoom_by(view.zoom < 1 ? 1 / view.zoom : 4, ...place(viewer, event));
        else view.fit();
        viewer.redraw();
    });
}

// Keys work wherever the focus is, except where they are already of use.
export function listen_to_keys(viewer: Viewer, order: number[], toggle_split: () => void): void {
    const {view} = viewer, step = 40;
    const pans: Record<string, [number, number]> = {
        ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step], ArrowDown: [0, -step]};
    const flip = (by: number): void => {
        const at = order.indexOf(viewer.state.shown);
        viewer.update({shown: order[(at + by + order.length) % order.length]!});
    };
    const actions: Record<string, () => void> = {
        "+": () => view.zoom_by(Math.SQRT2), "=": () => view.zoom_by(Math.SQRT2), "-": () => view.zoom_by(Math.SQRT1_2),
        f: () => view.fit(), s: toggle_split, "[": () => flip(-1), "]": () => flip(1),
        ",": () => flip(-1), ".": () => flip(1),
        e: () => viewer.update({exposure: viewer.state.exposure + 0.5}),
        E: () => viewer.update({exposure: viewer.state.exposure - 0.5}),
    };
    document.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const target = event.target as HTMLElement;
        if (target.matches("select, textarea, input:not([type=radio]):not([type=range]):not([type=checkbox])")) return;
        const digit = /^(?:Digit|Numpad)(\d)$/.exec(event.code);
        const pan = target === viewer.canvas ? pans[event.key] : undefined;
        if (digit) {
            const shown = order[Number(digit[1]) + (event.shiftKey ? 10 : 0)];
            if (shown === undefined) return;
            viewer.update({shown});
        } else if (pan) view.pan(...pan);
        else if (actions[event.key]) actions[event.key]!();
        else return;
        event.preventDefault();
        viewer.redraw();
    });
}
