// The values of one pixel, as text.

const number = (value, decimals, unit) => (value === null ? "–" : value.toLocaleString("en", { minimumFractionDigits: decimals, maximumFractionDigits: decimals }).replace("-", "−") + unit);
const status = (image, place) => (image.valid[place] ? "valid" : `rejected: ${image.status[place].join(", ")}`);

// Names and values of what a pixel has measured, and what it can expect.
export function facts(image, [row, column]) {
  const place = row * image.columns + column;
  const of = (values) => values[place];
  const [depth, truth, sigma] = [of(image.depth_m), of(image.true_m), of(image.sigma_m)];
  const error = depth === null || truth === null ? null : 1e3 * (depth - truth);
  return [
    ["depth", number(depth, 4, " m")],
    ["sigma", number(sigma === null ? null : 1e3 * sigma, 2, " mm")],
    ["status", status(image, place)],
    ["hits", number(of(image.hits), 0, "")],
    ["expected signal", number(of(image.signal_hits), 1, " hits")],
    ["expected ambient", number(of(image.ambient_hits), 1, " hits")],
    ["true depth", number(truth, 4, " m")],
    ["error", number(error, 2, " mm")],
  ];
}

// The same in a sentence, to be read out.
export function words(image, pixel) {
  const values = facts(image, pixel).map(([name, value]) => `${name} ${value}`);
  return `Row ${pixel[0]}, column ${pixel[1]}: ${values.join(", ")}`;
}
