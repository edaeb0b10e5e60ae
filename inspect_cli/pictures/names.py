"""Names of the files that are made."""

SCRIPT_NAME = "script.npz"
SCENE_NAME, FILM_NAME = "scene.png", "film.mp4"
