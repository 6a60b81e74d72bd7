// name: unstated-methods
// kind: table
// description: Which sanitizers have a label that does not say how they clean, so that what they pass on still counts?
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot
// returns sanitizer: string, name of the sanitizer
// returns category: string, the kind of data that the label names
// returns counted_as: string, the method that was taken instead
// returns label: string, file:line of the label that decides
// order: robot, sanitizer, category
MATCH (c:DataCategory)<-[s:SANITIZES]-(e:Element)
WHERE NOT coalesce(s.stated, s.method IS NOT NULL) AND c.name IN e.sanitizes AND ($robot = '' OR e.robot = $robot)
WITH DISTINCT e, c.name AS kind
CALL (e, kind) {
  MATCH (e)-[s:SANITIZES]->(:DataCategory)<-[up:BROADER*0..]-(:DataCategory {name: kind})
  WITH s, up, coalesce(s.stated, s.method IS NOT NULL) AS stated, coalesce(s.file + ':' + s.line, 'by hand') AS label
  ORDER BY coalesce(s.tier, 2) DESC, coalesce(s.specificity, 1000000) DESC, coalesce(s.every, false), size(up), stated,
           label LIMIT 1
  RETURN coalesce(s.method, 'pseudonymise') AS method, stated, label
}
WITH * WHERE NOT stated
RETURN e.robot AS robot, e.name AS sanitizer, kind AS category, method AS counted_as, label
ORDER BY robot, sanitizer, category
