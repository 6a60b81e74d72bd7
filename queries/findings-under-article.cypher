// name: findings-under-article
// kind: table
// description: To which findings, not counting dismissed ones, can an article of the GDPR apply, and why?
// param article: article, its number, such as 9, 9(1) or 10, default "9"
// param may: boolean, also data that only may reveal it; without these what may be of a kind that falls under it stays, default true
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// returns provision: string, short name of the provision
// returns verdict: string, whether the data falls under it: always, conditional or may-reveal
// returns condition: string, when; absent where it always does
// returns stated_of: string, the category, or the broader or narrower ones, that the ontology says it of
// returns robot: string, name of the robot of the source
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns special_from: string, where other data is made into such data on the way; absent if nowhere
// returns leak: string, where it gets out
// returns pseudonymised: boolean, whether it arrives in pseudonymised form only
// returns leak_robot: string, name of the robot of the leak, which may be another one
// returns may_be: boolean, whether a narrower kind, which the data may be, falls under it always or on a condition
// order: provision, robot, category, source, leak, leak_robot, verdict
WITH 'GDPR Art. ' + $article AS start
MATCH (p:LegalProvision)<-[u:FALLS_UNDER]-(c:DataCategory)
WHERE (p.name = start OR p.name STARTS WITH start + ' ' OR p.name STARTS WITH start + '(')
WITH p, u, c, u.verdict = 'may-reveal' AND EXISTS {
       (c)<-[:BROADER*1..]-()-[v:FALLS_UNDER]->(q)
       WHERE v.verdict <> 'may-reveal' AND (q.name = start OR q.name STARTS WITH start + ' '
                                            OR q.name STARTS WITH start + '(')
     } AS may_be
WHERE $may OR may_be OR u.verdict <> 'may-reveal'
MATCH (c)<-[:OF_CATEGORY]-(f:Finding {dismissed: false})
WHERE $robot = '' OR f.robot = $robot OR f.leak_robot = $robot
RETURN p.name AS provision, u.verdict AS verdict, u.condition AS condition, u.stated_of AS stated_of, f.robot AS robot,
       f.category AS category, f.source AS source, f.special_from AS special_from, f.leak AS leak,
       f.pseudonymised AS pseudonymised, f.leak_robot AS leak_robot, may_be
ORDER BY provision, robot, category, source, leak, leak_robot, verdict
