// The regions that hold the robot's position and heading with a probability of 95 %.

import type { RobotState } from "./wire";

export type Covariance = RobotState["covariance"];

/** Standard deviations of the half axes of an ellipse that holds 95 % of a plane's normal distribution, and of a line's. */
const SIGMAS_PLANE = 2.448;
const SIGMAS_LINE = 1.96;

export interface Ellipse {
  /** Half axes [m]. */
  long: number;
  short: number;
  /** Direction of the long axis in the map frame [rad]. */
  direction: number;
}

/** The ellipse that holds the position with 95 %. */
export function positionEllipse([xx, xy, yy]: Covariance): Ellipse {
  const mean = (xx + yy) / 2;
  const half = Math.hypot((xx - yy) / 2, xy);
  const axis = (variance: number) => SIGMAS_PLANE * Math.sqrt(Math.max(0, variance));
  return { long: axis(mean + half), short: axis(mean - half), direction: 0.5 * Math.atan2(2 * xy, xx - yy) };
}

/** The angle to each side of the heading that holds it with 95 % [rad]. */
export function headingBound(covariance: Covariance): number {
  return SIGMAS_LINE * Math.sqrt(Math.max(0, covariance[3]));
}
