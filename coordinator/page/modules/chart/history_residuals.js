// Residuals of a history against a model that is computed at other times.

/**
 * Returns measured minus model at the measured times that the model covers, with the model interpolated linearly
 * between its times.
 * @param {ChannelHistory} history
 * @param {{ t_s: number[], value: number[] }} model
 */
export function residuals(history, model) {
  const { t_s, value } = history.measured ?? { t_s: [], value: [] };
  let after = 0;
  return t_s.flatMap((t, k) => {
    while (after < model.t_s.length && model.t_s[after] < t) after += 1;
    if (after >= model.t_s.length || t < model.t_s[0]) return [];
    const before = Math.max(after - 1, 0);
    const span = model.t_s[after] - model.t_s[before];
    const share = span > 0 ? (t - model.t_s[before]) / span : 0;
    return [{ t, value: value[k] - (model.value[before] + share * (model.value[after] - model.value[before])) }];
  });
}
