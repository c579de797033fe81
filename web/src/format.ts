// Numbers as text.
import {is_number, type Estimate} from "./results";

const superscripts = "⁰¹²³⁴⁵⁶⁷⁸⁹";

export function power_of_ten(exponent: number): string {
    const digits = [...String(Math.abs(exponent))].map((digit) => superscripts[Number(digit)]).join("");
    return `10${exponent < 0 ? "⁻" : ""}${digits}`;
}

// Three significant digits: 0.0123, 1.50×10⁻⁵; integers up to 99,999 in full.
export function number_text(value: number | null | undefined, digits = 3): string {
    if (!is_number(value)) return "–";
    const magnitude = Math.abs(value);
    if (magnitude === 0) return "0";
    if (magnitude >= 1e-3 && magnitude < 99999.5) {
        if (Number.isInteger(value) || magnitude >= 10 ** (digits - 1)) return Math.round(value).toLocaleString("en").replace("-", "−");
        return value.toPrecision(digits).replace("-", "−");
    }
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${mantissa!.replace("-", "−")}×${power_of_ten(Number(exponent))}`;
}

export function interval_text(estimate: Estimate | undefined, digits = 3): string {
    if (!is_number(estimate?.low) || !is_number(estimate.high)) return "";
    return `[${number_text(estimate.low, digits)}, ${number_text(estimate.high, digits)}]`;
}

export function estimate_text(estimate: Estimate | undefined): string {
    return [number_text(estimate?.mean), interval_text(estimate)].filter(Boolean).join(" ");
}

export function percent_text(share: number | null | undefined): string {
    return is_number(share) ? `${(100 * share).toFixed(share < 0.0995 && share !== 0 ? 2 : 1)} %` : "–";
}

export function seconds_text(seconds: number): string {
    if (seconds < 120) return `${number_text(seconds)} s`;
    if (seconds < 7200) return `${number_text(seconds / 60)} min`;
    return `${number_text(seconds / 3600)} h`;
}
