export function harmless(page: string): { elements: { name: string; attributes: Record<string, string> }[]; text: string };
