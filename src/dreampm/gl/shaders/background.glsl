// How far from the color of the horizon to that above, by the sine of the height.
float background_share(float up) { return smoothstep(-0.1, 0.7, up); }
