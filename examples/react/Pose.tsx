import type { ColorImage, DepthMap, Options } from "bimodal-stereo";
import { usePose } from "./usePose";

/** The pose between two views in words. */
export function Pose({ image, depth, options }: { image: ColorImage; depth: DepthMap; options?: Options }) {
  const { report, error } = usePose(image, depth, options);
  if (error) return <p role="alert">{error.message}</p>;
  if (!report) return <p role="status">loading</p>;
  const { status, stage, iteration, message, pose } = report;
  const { alpha, beta, gamma } = pose.angles;
  return (
    <p role="status">
      {status} ({stage} {iteration}): alpha {alpha.toFixed(2)}, beta {beta.toFixed(2)}, gamma {gamma.toFixed(2)} degrees{" "}
      {message}
    </p>
  );
}
