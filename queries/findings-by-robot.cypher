// name: findings-by-robot
// kind: count
// description: How many findings does each robot have, by kind of data?
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot
// returns verdict: string, of the whole robot
// returns category: string, the kind of data that arrives
// returns findings: integer, how many pairs of source and leak, without the dismissed ones
// returns pseudonymised: integer, how many of these it reaches in pseudonymised form only
// returns dismissed: integer, how many more lie behind another leak of the category only
// order: robot, category
MATCH (f:Finding)
WHERE $robot = '' OR f.robot = $robot
WITH f.robot AS robot, f.category AS category, count(CASE WHEN f.dismissed THEN null ELSE f END) AS findings,
     count(CASE WHEN f.pseudonymised AND NOT f.dismissed THEN f END) AS pseudonymised,
     count(CASE WHEN f.dismissed THEN f END) AS dismissed
OPTIONAL MATCH (r:Robot {name: robot})
RETURN robot, r.verdict AS verdict, category, findings, pseudonymised, dismissed
ORDER BY robot, category
