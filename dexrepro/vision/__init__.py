"""Grasp detection with a safety region: grasp rectangles, image patches, scenes and the classifier."""
