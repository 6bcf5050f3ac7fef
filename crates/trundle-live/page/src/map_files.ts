// Saves the map on the computer of the viewer: picture, YAML, zones and places. Names of the maps that may be loaded.

const FILES = ["map.pgm", "map.yaml", "zones.geojson"];

/** Fetches the files of the map and hands them to the browser; a problem in a sentence, where there is one. */
export async function saveMap(token: string): Promise<string> {
  for (const name of FILES) {
    const response = await fetch(`/files/${name}`, { headers: { Authorization: `Bearer ${token}` } }).catch(() => null);
    if (!response?.ok) return `${name} cannot be saved: ${response ? await response.text() : "there is no link to the robot"}`;
    const link = document.createElement("a");
    const url = URL.createObjectURL(await response.blob());
    link.href = url;
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(url), 10_000);
  }
  return "";
}

/** The names of the maps that may be loaded; none without a link. */
export async function mapNames(token: string): Promise<string[]> {
  const response = await fetch("/maps", { headers: { Authorization: `Bearer ${token}` } }).catch(() => null);
  return response?.ok ? ((await response.json()) as string[]) : [];
}
