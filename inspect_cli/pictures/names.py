"""File names of the script, the still picture and the film."""

SCRIPT_NAME = "script.npz"
SCENE_NAME, FILM_NAME = "scene.png", "film.mp4"
