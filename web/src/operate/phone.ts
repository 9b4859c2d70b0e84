/** A phone looks on and holds, and nothing else. */
export const isPhone = matchMedia('(max-width: 719px)');
